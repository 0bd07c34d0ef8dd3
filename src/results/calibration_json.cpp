
#include "calibration_parts.hpp"
#include "document.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/results/calibrated_dh_table.hpp"
#include "posewright/results/stated_error.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

Json effect_json(const ScoreTest& t) {
  return {{"effect", t.name},
          {"gain", t.gain},
          {"share", t.share},
          {"freedom", t.freedom},
          {"statistic", finite_or_null(t.statistic)},
          {"probability", t.probability},
          {"corrected", t.corrected}};
}

/// A smooth effect that the residuals hold, and what the fit counts.
Json smooth_json(const Calibration& c) {
  const SmoothEffect& s = c.smooth;
  if (!s.why_not.empty()) return {{"why_not", s.why_not}, {"counted", nullptr}};
  return {{"why_not", nullptr},
          {"size", s.size},
          {"lower", s.lower},
          {"upper", finite_or_null(s.upper)},
          {"length", s.length},
          {"noise", s.noise},
          {"statistic", s.statistic},
          {"probability", s.probability},
          {"poses", s.poses},
          {"counted", c.counted ? Json{{"size", c.counted->size}, {"length", c.counted->length}} : Json(nullptr)}};
}

Json revisits_json(const Revisits& r) {
  if (!r.larger.possible) return nullptr;
  const auto moved = [](const Revisits::Moved& m) { return Json{{"reading", m.reading}, {"change", m.change}}; };
  return {{"places", r.places},
          {"visits", r.visits},
          {"noise", r.noise},
          {"probability", r.larger.probability},
          {"drift_probability", r.drift.possible ? Json(r.drift.probability) : Json(nullptr)},
          {"drift", list_json(r.moved, moved)}};
}

Json visits_json(const std::optional<VisitErrors>& visits) {
  if (!visits) return nullptr;
  return {{"position", visits->translation},
          {"rotation", visits->rotation},
          {"noise", visits->noise},
          {"probability", visits->probability}};
}

Json step_json(const std::optional<FrameStep>& step) {
  if (!step) return nullptr;
  return {{"frame", step->frame},
          {"before", step->before},
          {"after", step->after},
          {"share", step->share},
          {"chance", step->chance}};
}

Json interpolation_json(const std::optional<Interpolation>& i) {
  if (!i) return nullptr;
  if (!i->why_not.empty()) return {{"why_not", i->why_not}};
  return {{"why_not", nullptr}, {"unit", i->unit},       {"alone", i->alone}, {"interpolated", i->interpolated},
          {"gain", i->gain},    {"refused", !i->gains()}};
}

Json numbers(const std::vector<double>& values) { return list_json(values, finite_or_null); }

Json parameter_json(const Calibration& c, const CalibratedParameter& p) {
  const bool known = p.estimated && p.given.empty(), interval = known && turned_frame(c, p) == nullptr;
  const double half = p.half_width;
  return {{"name", p.label.name},
          {"unit", p.label.unit},
          {"role", p.label.role == Role::nuisance ? "nuisance" : "interest"},
          {"estimated", p.estimated},
          {"nominal", p.label.nominal},
          {"tolerance", p.label.tolerance},
          {"prior", !p.estimated || !p.prior   ? "none"
                    : p.label.tolerance_stated ? "stated"
                                               : "assumed"},
          {"tolerance_times", p.spread},
          {"value", p.value},
          {"sigma", known ? Json(p.sigma) : Json(nullptr)},
          {"interval", interval ? Json({finite_or_null(p.lower), finite_or_null(p.upper)}) : Json(nullptr)},
          {"interval_by", !interval ? Json(nullptr) : Json(p.profiled ? "profile" : "linear")},
          {"linear_interval", interval ? Json({p.value - half, p.value + half}) : Json(nullptr)},
          {"tells_less_than_tolerance", p.weak},
          {"why_not", text_or_null(p.why_not)},
          {"given", p.given}};
}

Json test_json(const TestResult& test) {
  if (!test.possible) return nullptr;
  return {{"statistic", test.statistic}, {"probability", test.probability}};
}

Json summary_json(const ResidualSummary& k) {
  return {{"kind", k.kind}, {"count", k.count},     {"rms", k.rms},
          {"mean", k.mean}, {"largest", k.largest}, {"largest_at_pose", k.pose}};
}

Json residuals_json(const Calibration& c) {
  Json sets = Json::array();
  for (const ResidualSet& set : c.residuals)
    for (const ResidualSummary& k : set.kinds) {
      sets.push_back({{"poses", set.poses}, {"parameters", set.parameters}});
      sets.back().update(summary_json(k));
    }
  return sets;
}

/// Null where it is not judged; members are null where no estimate predicts.
Json help_json(const std::optional<InstrumentHelp>& help) {
  if (!help) return nullptr;
  return {{"with", finite_or_null(help->with)},
          {"without", finite_or_null(help->without)},
          {"standard_errors", finite_or_null(help->gain)},
          {"alone", help->alone}};
}

/// Null for one instrument alone.
Json instruments_json(const Calibration& c) {
  Json list = nullptr;
  for (const InstrumentResiduals& one : c.instruments) {
    list.push_back({{"name", one.name},
                    {"poses", one.poses},
                    {"readings", one.readings},
                    {"noise_factor", one.noise_factor},
                    {"chi_square", one.chi_square},
                    {"freedom", one.test.possible ? Json(one.freedom) : Json(nullptr)},
                    {"probability", one.test.possible ? Json(one.test.probability) : Json(nullptr)},
                    {"residuals", list_json(one.kinds, summary_json)},
                    {"others", help_json(one.help)}});
  }
  return list;
}

Json orientations_json(const Calibration& c) {
  return list_json(c.orientations, [](const CalibratedOrientation& o) {
    return Json{{"frame", o.frame},
                {"rx_ry_rz", {o.angles[0], o.angles[1], o.angles[2]}},
                {"covariance", matrix_json(o.covariance)},
                {"half_width", {o.half_width[0], o.half_width[1], o.half_width[2]}}};
  });
}

Json left_out_json(const LeaveOut& left_out) {
  const auto judged = [&](double value) { return left_out.groups > 0 ? finite_or_null(value) : Json(nullptr); };
  return {{"groups", left_out.groups},
          {"estimated", judged(left_out.estimated)},
          {"placed", judged(left_out.placed)},
          {"gain", judged(left_out.gain)},
          {"gains", left_out.gains()},
          {"gain_in_range", left_out.gain_in_range ? Json(*left_out.gain_in_range) : Json(nullptr)},
          {"why_not", text_or_null(left_out.why_not)}};
}

/// Begin of every result of the command.
Json begin_calibration(const char* schema, const Problem& problem, const MeasuredFiles& files) {
  Json json = begin_document(schema, problem);
  json["data"] = files.data.string();
  json["campaigns"] = list_json(files.campaigns, [](const std::filesystem::path& file) { return file.string(); });
  return json;
}

Json figures_json(const Calibration& c) {
  Json parameters = Json::array(), readings = Json::array(), poses = Json::array();
  for (const CalibratedParameter& p : c.parameters) parameters.push_back(parameter_json(c, p));
  for (const Reading& reading : c.readings) readings.push_back({{"name", reading.name}, {"unit", reading.unit}});
  for (const PoseResidual& pose : c.pose_residuals)
    poses.push_back({{"id", pose.id},
                     {"held_back", pose.held_back},
                     {"weight", pose.weight},
                     {"before", numbers(pose.before)},
                     {"residuals", numbers(pose.residuals)},
                     {"accuracy", pose_accuracy_json(pose.accuracy)}});
  return {{"variant", c.variant},
          {"verdict", verdict_word(c.verdict)},
          {"refusals", c.refusals},
          {"weights", weighting_word(c.weighting)},
          {"prior", c.prior == Prior::none ? "none" : "manufactured"},
          {"rows", c.rows},
          {"poses_fitted", c.poses},
          {"poses_held_back", c.held_back},
          {"repeats", c.repeats},
          {"converged", c.fit.converged},
          {"expected_error", c.expected ? expected_error_json(*c.expected) : Json(nullptr)},
          {"parameters", parameters},
          {"covariance", {{"columns", c.columns}, {"rows", matrix_json(c.fit.covariance)}}},
          {"orientations", orientations_json(c)},
          {"frames", frames_json(c)},
          {"leg_points", leg_points_json(c)},
          {"noise_factor", c.fit.noise_factor},
          {"noise_scale", c.fit.scale},
          {"chi_square", c.fit.chi_square},
          {"freedom", c.fit.freedom},
          {"tests",
           {{"chi_square", test_json(c.tests.chi_square)},
            {"lack_of_fit", test_json(c.lack_of_fit)},
            {"serial_correlation", test_json(c.tests.serial)},
            {"within_pose_correlation", test_json(c.tests.within)},
            {"normality", test_json(c.tests.normality)}}},
          {"effects_left_out", list_json(c.effects, effect_json)},
          {"visit_errors", visits_json(c.visits)},
          {"frame_step", step_json(c.step)},
          {"smooth_effect", smooth_json(c)},
          {"revisits", revisits_json(c.revisits)},
          {"not_in_auto", c.not_in_auto},
          {"interpolation", interpolation_json(c.interpolation)},
          {"left_out", left_out_json(c.left_out)},
          {"weakest_combination", text_or_null(c.weakest)},
          {"curvature", finite_or_null(c.curvature.largest)},
          {"intrinsic_curvature", finite_or_null(c.curvature.intrinsic)},
          {"histogram", {{"from", -4.5}, {"bin_width", 0.5}, {"counts", c.tests.histogram}}},
          {"residuals", residuals_json(c)},
          {"instruments", instruments_json(c)},
          {"axes", axes_json(c)},
          {"requirements", requirements_json(c)},
          {"in_steps", steps_json(c)},
          {"compensator", c.compensator ? compensator_json(*c.compensator) : Json(nullptr)},
          {"platform", c.platform ? platform_json(*c.platform) : Json(nullptr)},
          {"before", c.placed ? "placed" : "nominal"},
          {"readings", readings},
          {"spread_within_pose", c.spread.empty() ? Json(nullptr) : numbers(c.spread)},
          {"poses", poses},
          {"notes", c.notes}};
}

}  // namespace

std::string weighting_word(Weighting weighting) {
  return weighting == Weighting::ordinary ? "ols" : weighting == Weighting::weighted ? "wls" : "robust";
}

std::string verdict_word(Verdict verdict) {
  return verdict == Verdict::use_it ? "use it" : verdict == Verdict::gain_not_shown ? "gain not shown" : "do not use";
}

Weighting weighting_of(std::string_view word) {
  for (const Weighting weighting : {Weighting::ordinary, Weighting::robust})
    if (word == weighting_word(weighting)) return weighting;
  return Weighting::weighted;
}

Json calibration_json(const Problem& problem, const MeasuredFiles& files, const Calibration& calibration,
                      const std::optional<DhTable>& table) {
  Json json = begin_calibration("posewright/calibration/1", problem, files);
  json.update(figures_json(calibration));
  json["denavit_hartenberg"] = table ? dh_table_json(*table) : Json(nullptr);
  return json;
}

Json models_json(const Problem& problem, const MeasuredFiles& files, const std::vector<Calibration>& models,
                 const ModelChoice& choice) {
  Json json = begin_calibration("posewright/calibrations/1", problem, files);
  json["recommended"] = text_or_null(choice.recommended);
  json["why"] = choice.why;
  const auto value = [](const std::optional<double>& v) { return v ? finite_or_null(*v) : Json(nullptr); };
  json["choice"] = list_json(choice.models, [&](const JudgedModel& m) {
    return Json{{"variant", m.variant},
                {"parameters", m.parameters},
                {"left_out", finite_or_null(m.left_out)},
                {"aicc", value(m.aicc)},
                {"against", text_or_null(m.against)},
                {"f", value(m.f)},
                {"probability", value(m.probability)}};
  });
  json["models"] = list_json(models, [&](const Calibration& model) { return calibration_json(problem, files, model); });
  return json;
}

Json compensator_json(const Problem& problem, const MeasuredFiles& files, const CompensatorConstants& constants) {
  Json json = begin_calibration("posewright/compensator/1", problem, files);
  json["compensator"] = compensator_json(constants);
  return json;
}

const CalibratedOrientation* turned_frame(const Calibration& calibration, const CalibratedParameter& parameter) {
  const std::string& name = parameter.label.name;
  for (const CalibratedOrientation& o : calibration.orientations)
    for (const char* angle : {".rx", ".ry", ".rz"})
      if (name == o.frame + angle) return &o;
  return nullptr;
}

std::optional<CalibratedEffect> shown_effect(const Calibration& calibration) {
  constexpr double level = 0.05;
  if (calibration.smooth.shown(level)) return CalibratedEffect{calibration.smooth.size, calibration.smooth.length};
  return std::nullopt;
}

}  // namespace posewright
