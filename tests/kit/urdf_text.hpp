#pragma once

#include <fmt/format.h>

#include <ostream>
#include <string>
#include <vector>

/// URDF of a serial chain from a list of joints; links are base, link_1, …; the last joint is fixed and ends in `tip`.
namespace posewright {

struct WrittenJoint {
  char kind;  ///< R revolute, C continuous, P prismatic
  const char* xyz;
  const char* rpy;
  const char* axis;
};

inline std::string urdf_text(const std::vector<WrittenJoint>& joints, const char* tip_xyz = "0.1 0.05 0.2") {
  std::string text = "<robot name=\"chain\">\n  <link name=\"base\"/>\n";
  std::string parent = "base";
  int n = 0;
  for (const WrittenJoint& joint : joints) {
    const std::string child = fmt::format("link_{}", ++n);
    text += fmt::format(
        "  <link name=\"{0}\"/>\n  <joint name=\"j{1}\" type=\"{2}\"><parent link=\"{3}\"/><child link=\"{0}\"/>"
        "<origin xyz=\"{4}\" rpy=\"{5}\"/><axis xyz=\"{6}\"/>{7}</joint>\n",
        child, n,
        joint.kind == 'R'   ? "revolute"
        : joint.kind == 'C' ? "continuous"
                            : "prismatic",
        parent, joint.xyz, joint.rpy, joint.axis,
        joint.kind == 'C'   ? ""
        : joint.kind == 'R' ? "<limit lower=\"-2.5\" upper=\"2.5\" effort=\"1\" velocity=\"1\"/>"
                            : "<limit lower=\"-0.4\" upper=\"0.6\" effort=\"1\" velocity=\"1\"/>");
    parent = child;
  }
  return text + fmt::format(
                    "  <link name=\"tip\"/>\n  <joint name=\"end\" type=\"fixed\"><parent link=\"{}\"/>"
                    "<child link=\"tip\"/><origin xyz=\"{}\" rpy=\"0.3 -0.2 0.1\"/></joint>\n</robot>\n",
                    parent, tip_xyz);
}

struct NamedChain {
  const char* name;
  std::vector<WrittenJoint> joints;
  int dh_deficit = 0;  ///< Denavit–Hartenberg parameters fewer than 4R + 2P + 6: where the convention is incomplete
};

inline void PrintTo(const NamedChain& chain, std::ostream* out) { *out << chain.name; }

/// Kinds of arms.
inline std::vector<NamedChain> named_chains() {
  const char *o = "0 0 0", *x = "1 0 0", *y = "0 1 0", *z = "0 0 1", *none = "0 0 0";
  return {
      {"generic_6R",
       {{'R', "0.1 0.2 0.3", "0.1 0.2 0.3", "0.2 0.3 0.9"},
        {'R', "0.3 0.1 0.2", "0.5 -0.2 0.4", "0.8 0.1 0.3"},
        {'R', "0.4 -0.1 0.1", "-0.3 0.6 0.2", "0.1 0.9 0.2"},
        {'R', "0.2 0.3 -0.1", "0.7 0.1 -0.5", "0.5 0.5 0.7"},
        {'R', "0.1 0.1 0.3", "-0.4 0.3 0.6", "0.9 0.2 -0.4"},
        {'R', "0.2 -0.2 0.1", "0.2 -0.7 0.1", "0.3 -0.4 0.8"}}},
      {"anthropomorphic_6R",
       {{'R', o, none, z},
        {'R', "0.35 0 0.75", none, y},
        {'R', "1.25 0 0", none, y},
        {'R', "1.1 0 -0.055", none, x},
        {'R', o, none, y},
        {'R', o, none, x}}},
      {"elbow_with_parallel_axes_6R",
       {{'R', "0 0 0.1", none, z},
        {'R', "0 0.1 0", none, y},
        {'R', "0.6 0 0", none, y},
        {'R', "0.5 0 0", none, y},
        {'R', "0 0.1 0", none, z},
        {'R', "0 0 -0.1", none, y}}},
      {"redundant_7R",
       {{'C', "0 0 0.3", none, z},
        {'R', o, none, y},
        {'R', "0 0 0.4", none, z},
        {'R', "0.05 0 0", none, y},
        {'R', "-0.05 0 0.4", none, z},
        {'R', o, none, y},
        {'R', "0.08 0 0", none, z}}},
      {"scara_RRPR",
       {{'R', "0 0 0.3", none, z}, {'R', "0.4 0 0", none, z}, {'P', "0.3 0 0", none, z}, {'C', o, none, z}}},
      {"stanford_RRPRRR",
       {{'R', "0 0 0.4", none, z},
        {'R', "0 0.15 0", none, y},
        {'P', "0 0 0.3", none, z},
        {'R', o, none, z},
        {'R', o, none, y},
        {'R', o, none, z}}},
      {"gantry_PPPRRR",
       {{'P', o, none, x},
        {'P', o, none, y},
        {'P', o, none, z},
        {'R', "0 0 -0.2", none, z},
        {'R', o, none, y},
        {'R', "0.05 0 0", none, x}}},
      {"cylindrical_RPP", {{'C', o, none, z}, {'P', "0 0 0.3", none, z}, {'P', "0.2 0 0", none, x}}},
      {"track_and_arm_P6R",
       {{'P', o, none, x},
        {'R', "0 0 0.3", none, z},
        {'R', "0.2 0 0.3", none, y},
        {'R', "0.8 0 0", none, y},
        {'R', "0.9 0 0.1", none, x},
        {'R', o, none, y},
        {'R', o, none, x}}},
      {"generic_4R2P",
       {{'R', "0.1 0.2 0.3", "0.1 0.2 0.3", "0.2 0.3 0.9"},
        {'P', "0.3 0.1 0.2", "0.5 -0.2 0.4", "0.8 0.1 0.3"},
        {'R', "0.4 -0.1 0.1", "-0.3 0.6 0.2", "0.1 0.9 0.2"},
        {'R', "0.2 0.3 -0.1", "0.7 0.1 -0.5", "0.5 0.5 0.7"},
        {'P', "0.1 0.1 0.3", "-0.4 0.3 0.6", "0.9 0.2 -0.4"},
        {'R', "0.2 -0.2 0.1", "0.2 -0.7 0.1", "0.3 -0.4 0.8"}}},
      {"turntable_2R", {{'C', o, none, z}, {'R', "0.1 0 0.2", none, y}}},
      {"positioner_3P", {{'P', o, none, x}, {'P', "0.1 0 0", none, y}, {'P', "0 0 0.2", none, z}}},
      // Two coaxial joints in a row: one offset less shows, one sideways shift of the second axis more. The first has
      // no direction for a common normal, so Denavit–Hartenberg parameters lack that shift.
      {"coaxial_pair_RRR", {{'R', o, none, z}, {'R', "0 0 0.2", none, z}, {'R', "0.3 0 0", none, y}}, -1},
  };
}

}  // namespace posewright
