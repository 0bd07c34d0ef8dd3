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

/// Number of members of a plain struct. A wrong number does not compile, so no member that is added later can be left
/// out.
template <class T>
constexpr int members = 0;
template <>
constexpr int members<Placement> = 2;
template <>
constexpr int members<LoadCaseSpec> = 6;
template <>
constexpr int members<CompensatorSpec> = 8;
template <>
constexpr int members<ElastostaticSpec> = 8;
template <>
constexpr int members<ElastostaticSpec::Listed> = 3;
template <>
constexpr int members<JointEffectsSpec> = 7;
template <>
constexpr int members<TemperatureSpec> = 2;
template <>
constexpr int members<TipSpec> = 2;
template <>
constexpr int members<WaySpec> = 2;
template <>
constexpr int members<SerialArmSpec> = 16;
template <>
constexpr int members<LegSpec> = 5;
template <>
constexpr int members<SixLegsSpec> = 8;
template <>
constexpr int members<FiveBarSpec> = 7;
template <>
constexpr int members<FiveBarSpec::Leg> = 4;
template <>
constexpr int members<DeltaSpec> = 10;
template <>
constexpr int members<CompensatorGeometrySpec> = 6;
template <>
constexpr int members<GivenPosesSpec> = 2;
template <>
constexpr int members<TargetSpec> = 3;
template <>
constexpr int members<GaussianNoise> = 1;
template <>
constexpr int members<TrackerNoise> = 4;
template <>
constexpr int members<StationSpec> = 2;
template <>
constexpr int members<PoseMeasurement> = 6;
template <>
constexpr int members<PointsMeasurement> = 4;
template <>
constexpr int members<DistanceMeasurement> = 6;
template <>
constexpr int members<PlaneMeasurement> = 7;
template <>
constexpr int members<LineMeasurement> = 8;
template <>
constexpr int members<InclinationMeasurement> = 5;
template <>
constexpr int members<CameraMeasurement> = 14;
template <>
constexpr int members<JointsMeasurement> = 3;
template <>
constexpr int members<LineOfSightSpec> = 14;
template <>
constexpr int members<InstrumentList> = 1;
template <>
constexpr int members<TogetherMeasurement> = 1;
template <>
constexpr int members<Repeatability> = 3;
template <>
constexpr int members<MeasurementSpec> = 14;
template <>
constexpr int members<BoxShape> = 1;
template <>
constexpr int members<CylinderShape> = 2;
template <>
constexpr int members<SphereShape> = 1;
template <>
constexpr int members<HalfSpaceShape> = 1;
template <>
constexpr int members<MeshShape> = 2;
template <>
constexpr int members<TrianglesShape> = 2;
template <>
constexpr int members<BodySpec> = 6;
template <>
constexpr int members<ObstacleFileSpec> = 4;
template <>
constexpr int members<CollisionSpec> = 11;
template <>
constexpr int members<CollisionSpec::PairClearance> = 3;
template <>
constexpr int members<CoupledLimits> = 5;
template <>
constexpr int members<ToolBoxSpec> = 3;
template <>
constexpr int members<SingularitySpec> = 3;
template <>
constexpr int members<MotionSpec> = 11;
template <>
constexpr int members<StationChoiceSpec> = 3;
template <>
constexpr int members<Measured> = 2;
template <>
constexpr int members<ControllerSettings> = 11;
template <>
constexpr int members<CoordinateLimits> = 4;
template <>
constexpr int members<WorkspaceSpec> = 15;
template <>
constexpr int members<PatternValue> = 3;
template <>
constexpr int members<UnmodelledSpec> = 4;
template <>
constexpr int members<VariantSpec> = 10;
template <>
constexpr int members<ParameterEntry> = 4;
template <>
constexpr int members<CalibratedEffect> = 2;
template <>
constexpr int members<CalibratedParameters> = 6;

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
