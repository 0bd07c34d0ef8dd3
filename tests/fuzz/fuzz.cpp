// Every reader of a file under libFuzzer with sanitizers: POSEWRIGHT_FUZZ_TARGET names the one. Whatever the bytes are,
// it returns or throws InputError, CannotDo or (of meshes) BadMesh, and nothing else happens.

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "posewright/blocks/read_blocks.hpp"
#include "posewright/controller/controller_settings.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/lists/measured_data.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/lists/samples.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/srdf.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/problem/calibrated_parameters.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/programs/program_document.hpp"
#include "posewright/support/error.hpp"
#include "src/cell/obstacle_files.hpp"
#include "src/cell/triangle_files.hpp"
#include "tests/kit/urdf_text.hpp"

namespace posewright {
namespace {

/// Bytes as a file that has a name, without a disk.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& bytes) : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    if (descriptor_ < 0 || ::write(descriptor_, bytes.data(), bytes.size()) != ssize_t(bytes.size())) std::abort();
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

const std::string& arm() {
  static const std::string text = urdf_text({{'R', "0 0 0.4", "0 0 0", "0 0 1"}, {'P', "0.1 0 0.1", "0 0 0", "0 1 0"}});
  return text;
}

struct Measurement {
  MemoryFile urdf{arm()};
  Problem problem =
      parse_problem("posewright: 1\nrobot: {urdf: " + urdf.path() +
                        ", tip: tip}\nmeasurement: {type: points, targets: {P1: [0.1, 0, 0], P2: [0, 0.1, 0]}, "
                        "device: {type: isotropic, noise: 0.1 mm}}\nvariants: {all: {parameters: auto}}\n",
                    "/proc/self/p.yaml");
  std::unique_ptr<IdentificationModel> model = make_model({problem, problem.variants.front()});
};

const Measurement& measurement() {
  static const Measurement instance;
  return instance;
}

void read_urdf(const std::string& bytes) {
  const MemoryFile file(bytes);
  SerialArmSpec spec;
  spec.urdf = file.path();
  read_urdf_chain(spec, {"p.yaml", 1});
}

/// The first byte chooses the format.
void read_list(const std::string& bytes) {
  static const std::vector<const PoseFormat*> formats = [] {
    std::vector<const PoseFormat*> readable;
    for (const PoseFormat& format : pose_formats())
      if (format.read != nullptr) readable.push_back(&format);
    return readable;
  }();
  if (bytes.empty()) return;
  const auto choice = static_cast<unsigned char>(bytes.front());
  read_poses_text(bytes.substr(1), "list", measurement().model->coordinates(),
                  choice == 0 ? "" : formats[choice % formats.size()]->name);
}

/// A plan or route is read, and written in every format that takes it.
void read_sequence(const std::string& bytes) {
  const PoseSequence sequence = parse_sequence(bytes, "plan.json");
  ExportOptions options;
  options.coupling = 1;
  options.digital_output = "1";
  for (const PoseFormat& format : pose_formats()) {
    try {
      export_poses(format, sequence, options);
    } catch (const InputError&) {
      continue;
    } catch (const CannotDo&) {
      continue;
    }
  }
}

/// The first byte chooses the language. All points get other values, and what is written is read again.
void read_program(const std::string& bytes) {
  static const std::array<const char*, 7> formats = {"kuka-krl",       "abb-rapid",    "fanuc-tp",        "urscript",
                                                     "yaskawa-inform", "staubli-val3", "joint-trajectory"};
  if (bytes.empty()) return;
  const std::string format = formats[static_cast<unsigned char>(bytes.front()) % formats.size()];
  ProgramRobot robot{{"j1", "j2", "j3", "j4", "j5", "j6"}, std::vector<std::string>(6, "rad"), {}, 0.0};
  robot.settings.pulses_per_degree = std::vector<double>(6, 1000);
  const auto document = std::move(read_programs({{format, bytes.substr(1), "program"}}, robot).front());
  std::vector<std::optional<ProgramDocument::Values>> values;
  for (std::size_t p = 0; p < document->points().size(); ++p) {
    const ProgramDocument::Point& point = document->points()[p];
    const ArmStand stand{std::vector<double>(6, 0.1)};
    if (point.is_pose()) document->meant(p, {stand, stand});
    values.emplace_back(ProgramDocument::Values{point.is_pose() ? stand : ArmStand{point.joints}, point.X_BaseTip});
  }
  const std::string again = document->text(values, "remark");
  if (read_programs({{format, again, "program"}}, robot).front()->points().size() != values.size()) std::abort();
}

using Read = void (*)(const std::string&);
const std::array<std::pair<const char*, Read>, 15> targets = {{
    {"problem", [](const std::string& bytes) { parse_problem(bytes, "problem.yaml"); }},
    {"urdf", read_urdf},
    {"stl", [](const std::string& bytes) { read_stl(bytes); }},
    {"obj", [](const std::string& bytes) { read_obj(bytes); }},
    {"npy",
     [](const std::string& bytes) {
       parse_npy(bytes, 3, {"blocks.npy", 0});
     }},
    {"blocks",
     [](const std::string& bytes) {
       const MemoryFile file(bytes);
       read_blocks(file.path(), 3);
     }},
    {"measured",
     [](const std::string& bytes) {
       const MemoryFile file(bytes);
       read_measured_data(file.path(), measurement().problem, *measurement().model);
     }},
    {"sequence", read_sequence},
    {"parameters", [](const std::string& bytes) { parse_calibrated_parameters(bytes, "parameters.yaml"); }},
    {"srdf",
     [](const std::string& bytes) {
       const MemoryFile file(bytes);
       read_srdf_pairs(file.path(), {"p.yaml", 1});
       read_srdf_group(file.path(), {"arm", 1}, {"p.yaml", 1});
     }},
    {"scene",
     [](const std::string& bytes) {
       const MemoryFile file(bytes);
       ObstacleFileSpec spec;
       spec.file = file.path();
       read_moveit_shapes(spec);
     }},
    {"settings", [](const std::string& bytes) { parse_controller_settings(bytes, "controller.yaml"); }},
    {"lists", read_list},
    {"programs", read_program},
    {"samples", [](const std::string& bytes) { read_samples(bytes, "samples.yaml"); }},
}};

Read chosen_target() {
  const char* wanted = std::getenv("POSEWRIGHT_FUZZ_TARGET");
  for (const auto& [name, read] : targets)
    if (wanted != nullptr && std::string(wanted) == name) return read;
  std::fprintf(stderr, "POSEWRIGHT_FUZZ_TARGET is one of:");
  for (const auto& [name, read] : targets) std::fprintf(stderr, " %s", name);
  std::fprintf(stderr, "\n");
  std::exit(2);
}

}  // namespace
}  // namespace posewright

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace posewright;
  static const Read read = chosen_target();
  try {
    read(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const InputError& error) {
    // One line, whatever stands in the file.
    if (std::string(error.what()).find('\n') != std::string::npos) std::abort();
  } catch (const CannotDo&) {
    return 0;
  } catch (const BadMesh&) {
    return 0;
  }
  return 0;
}
