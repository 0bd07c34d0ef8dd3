#include "posewright/problem/structure.hpp"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <type_traits>
#include <variant>
#include <vector>

#include "posewright/support/bytes.hpp"

namespace posewright {
namespace {

template <class T, class... Others>
constexpr bool is_one_of = (std::is_same_v<T, Others> || ...);

/// Number of members of a plain struct. A wrong number does not compile, so no member that is added later can be left
/// out.
template <class T>
constexpr int members =
    is_one_of<T, GaussianNoise, InstrumentList, TogetherMeasurement, BoxShape, SphereShape, HalfSpaceShape> ? 1
    : is_one_of<T, Placement, TemperatureSpec, TipSpec, WaySpec, GivenPosesSpec, StationSpec, CylinderShape, MeshShape,
                TrianglesShape, Measured, CalibratedEffect>
        ? 2
    : is_one_of<T, ElastostaticSpec::Listed, TargetSpec, JointsMeasurement, Repeatability, CollisionSpec::PairClearance,
                ToolBoxSpec, SingularitySpec, StationChoiceSpec, PatternValue>
        ? 3
    : is_one_of<T, FiveBarSpec::Leg, TrackerNoise, PointsMeasurement, ObstacleFileSpec, CoordinateLimits,
                UnmodelledSpec, ParameterEntry>
        ? 4
    : is_one_of<T, LegSpec, InclinationMeasurement, CoupledLimits> ? 5
    : is_one_of<T, LoadCaseSpec, CompensatorGeometrySpec, PoseMeasurement, DistanceMeasurement, BodySpec,
                CalibratedParameters>
        ? 6
    : is_one_of<T, JointEffectsSpec, FiveBarSpec, PlaneMeasurement>                 ? 7
    : is_one_of<T, CompensatorSpec, ElastostaticSpec, SixLegsSpec, LineMeasurement> ? 8
    : is_one_of<T, DeltaSpec, VariantSpec>                                          ? 10
    : is_one_of<T, CollisionSpec, MotionSpec, ControllerSettings>                   ? 11
    : is_one_of<T, CameraMeasurement, LineOfSightSpec, MeasurementSpec>             ? 14
    : is_one_of<T, WorkspaceSpec>                                                   ? 15
    : is_one_of<T, SerialArmSpec>                                                   ? 16
                                                                                    : 0;

class Writer {
 public:
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) bytes_.put(value);
    else put_members(value);
  }
  void put(const std::string& text) { bytes_.put(text); }
  void put(const std::filesystem::path& file) { bytes_.put(file.empty()); }
  template <class T>
  void put(const Located<T>& located) {
    put(located.value);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class T>
  void put(const std::shared_ptr<T>& value) {
    put(value != nullptr);
    if (value != nullptr) put(*value);
  }
  template <class... T>
  void put(const std::variant<T...>& value) {
    put(value.index());
    std::visit([&](const auto& held) { put(held); }, value);
  }
  template <class A, class B>
  void put(const std::pair<A, B>& pair) {
    put(pair.first);
    put(pair.second);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put_all(values);
  }
  template <class T, std::size_t n>
  void put(const std::array<T, n>& values) {
    put_all(values);
  }
  template <class A, class B>
  void put(const std::map<A, B>& values) {
    put_all(values);
  }
  template <class T, int m, int n>
  void put(const Eigen::Matrix<T, m, n>& matrix) {
    static_assert(m > 0 && n > 0);
    for (const T& value : matrix.reshaped()) put(value);
  }
  std::string take() { return bytes_.take(); }

 private:
  template <class T>
  void put_all(const T& values) {
    put(values.size());
    for (const auto& value : values) put(value);
  }
  template <class... T>
  void put_each(const T&... values) {
    (put(values), ...);
  }

  template <class T>
  void put_members(const T& value) {
    constexpr int count = members<T>;
    static_assert(count > 0 && count <= 16, "a struct without a row in the table above");
    if constexpr (count == 1) {
      const auto& [a] = value;
      put_each(a);
    } else if constexpr (count == 2) {
      const auto& [a, b] = value;
      put_each(a, b);
    } else if constexpr (count == 3) {
      const auto& [a, b, c] = value;
      put_each(a, b, c);
    } else if constexpr (count == 4) {
      const auto& [a, b, c, d] = value;
      put_each(a, b, c, d);
    } else if constexpr (count == 5) {
      const auto& [a, b, c, d, e] = value;
      put_each(a, b, c, d, e);
    } else if constexpr (count == 6) {
      const auto& [a, b, c, d, e, f] = value;
      put_each(a, b, c, d, e, f);
    } else if constexpr (count == 7) {
      const auto& [a, b, c, d, e, f, g] = value;
      put_each(a, b, c, d, e, f, g);
    } else if constexpr (count == 8) {
      const auto& [a, b, c, d, e, f, g, h] = value;
      put_each(a, b, c, d, e, f, g, h);
    } else if constexpr (count == 9) {
      const auto& [a, b, c, d, e, f, g, h, i] = value;
      put_each(a, b, c, d, e, f, g, h, i);
    } else if constexpr (count == 10) {
      const auto& [a, b, c, d, e, f, g, h, i, j] = value;
      put_each(a, b, c, d, e, f, g, h, i, j);
    } else if constexpr (count == 11) {
      const auto& [a, b, c, d, e, f, g, h, i, j, k] = value;
      put_each(a, b, c, d, e, f, g, h, i, j, k);
    } else if constexpr (count == 12) {
      const auto& [a, b, c, d, e, f, g, h, i, j, k, l] = value;
      put_each(a, b, c, d, e, f, g, h, i, j, k, l);
    } else if constexpr (count == 13) {
      const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = value;
      put_each(a, b, c, d, e, f, g, h, i, j, k, l, m);
    } else if constexpr (count == 14) {
      const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = value;
      put_each(a, b, c, d, e, f, g, h, i, j, k, l, m, n);
    } else if constexpr (count == 15) {
      const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o] = value;
      put_each(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o);
    } else if constexpr (count == 16) {
      const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = value;
      put_each(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p);
    }
  }

  ByteWriter bytes_;
};

}  // namespace

std::string structure_of(const Problem& problem) {
  Writer writer;
  writer.put(problem.robot);
  writer.put(problem.measurement);
  writer.put(problem.workspace);
  writer.put(problem.parameters);
  writer.put(problem.design.variant);
  writer.put(problem.variants);
  return writer.take();
}

std::string structure_of(const VariantSpec& variant) {
  Writer writer;
  writer.put(variant);
  return writer.take();
}

}  // namespace posewright
