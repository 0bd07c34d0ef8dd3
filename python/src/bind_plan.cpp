#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <limits>

#include "arrays.hpp"
#include "bindings.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/table.hpp"

namespace posewright::python {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::optional<std::string> text_or_none(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

py::object tool_pose(const PlannedPose& pose) {
  if (!pose.tool_pose) return py::none();
  return array_of(Eigen::MatrixXd(pose.tool_pose->matrix()));
}

void bind_parameter(py::module_& m) {
  using P = PlannedParameter;
  py::class_<P>(m, "Parameter", "One model parameter; values in `unit`, which is SI.")
      .def_property_readonly("name", [](const P& p) { return p.label.name; })
      .def_property_readonly(
          "unit", [](const P& p) { return p.label.unit; }, "m, rad, … or 1 for a number without dimension")
      .def_property_readonly("role",
                             [](const P& p) { return p.label.role == Role::interest ? "interest" : "nuisance"; })
      .def_property_readonly("nominal", [](const P& p) { return p.label.nominal; })
      .def_property_readonly(
          "tolerance", [](const P& p) { return p.label.tolerance; }, "1σ known before the calibration")
      .def_readonly("sigma", &P::sigma, "predicted 1σ after it; None where it is not identified or not predicted")
      .def_property_readonly(
          "variant", [](const P& p) { return text_or_none(p.variant); }, "where a plan serves several")
      .def_property_readonly(
          "dropped_because", [](const P& p) { return text_or_none(p.dropped_because); },
          "the equation that hides it among kept parameters")
      .def_property_readonly(
          "worth_identifying",
          [](const P& p) { return p.sigma ? std::optional(*p.sigma < p.label.tolerance) : std::nullopt; },
          "whether sigma is below the tolerance")
      .def("__repr__", [](const P& p) {
        std::string text = "<Parameter " + p.label.name;
        if (p.sigma) text += py::str(": sigma {:.3g} {}").format(*p.sigma, p.label.unit);
        return text + (p.dropped_because.empty() ? ">" : ": dropped>");
      });
}

void bind_pose(py::module_& m) {
  using P = PlannedPose;
  py::class_<P> bound(m, "Pose", "One pose of a plan; SI units.");
  for (const ChoiceKey& key : choice_keys)
    bound.def_property_readonly(key.name, [key](const P& p) { return text_or_none(label_of(p.choices, key.name)); });
  bound.def_readonly("id", &P::id, "1, 2, … as in the files")
      .def_readonly("candidate", &P::candidate,
                    "zero-based index of the candidate or block; None where it was found between them")
      .def_readonly("measured", &P::measured, "was there before: not to be measured again")
      .def_readonly("fixed", &P::fixed, "was in the plan before the search, still to be measured")
      .def_property_readonly("configuration",
                             [](const P& p) { return array_of(of_each(p.configuration, &NamedValue::value)); })
      .def_property_readonly("names", [](const P& p) { return of_each(p.configuration, &NamedValue::name); })
      .def_property_readonly("units", [](const P& p) { return of_each(p.configuration, &NamedValue::unit); })
      .def_property_readonly(
          "actuators", [](const P& p) { return dict_of(p.actuators, &NamedValue::name, &NamedValue::value); },
          "of a parallel robot, by name")
      .def_property_readonly("tool_pose", &tool_pose, "4 × 4, nominal, in the measurement frame; None for bare blocks")
      .def_readonly("contribution", &P::contribution, "share of all information")
      .def_property_readonly(
          "efficiency_without", [](const P& p) { return p.measured ? std::nullopt : std::optional(p.without); },
          "what is left of the plan without it; 0: not identifiable")
      .def("__repr__", [](const P& p) {
        return py::str("<Pose {}: {:.1f} % of the information>").format(p.id, 100 * p.contribution);
      });
}

void bind_certificate(py::module_& m) {
  using C = Certificate;
  py::class_<C::Workspace>(m, "WorkspaceCertificate", "What a proof, or else a search, says over the whole workspace.")
      .def_readonly("efficiency", &C::Workspace::efficiency)
      .def_readonly("bound", &C::Workspace::bound)
      .def_readonly("max_sensitivity_ratio", &C::Workspace::max_sensitivity_ratio)
      .def_readonly("method", &C::Workspace::method)
      .def_readonly("settled", &C::Workspace::settled, "proved, or the search came to its end")
      .def_readonly("at_most", &C::Workspace::at_most,
                    "share of the best weights found; no more is reached of the best");
  py::class_<C>(m, "Certificate", "What is proved about a plan over its candidates.")
      .def_readonly("efficiency", &C::efficiency, "lower bound of what the plan reaches of the best, in (0, 1]")
      .def_readonly("bound", &C::bound, "no plan of as many of these candidates exceeds it")
      .def_readonly("max_sensitivity_ratio", &C::max_sensitivity_ratio)
      .def_readonly("count", &C::count, "candidates")
      .def_readonly("found", &C::found, "how many of them were found beyond those drawn")
      .def_readonly("repeats", &C::repeats, "what the bound allows: forbid, allow or a number")
      .def_readonly("apart", &C::apart, "the bound is of plans alone that keep the minimum distance")
      .def_readonly("limited", &C::limited, "the bound is of plans alone that keep `most` of each instrument")
      .def_readonly("workspace", &C::workspace, "the same over the whole workspace, or None")
      .def("__repr__", [](const C& c) {
        return py::str("<Certificate: at least {} of the best of {} candidates>")
            .format(percent(c.efficiency), c.count);
      });
}

py::array_t<double> sigma(const Plan& plan) {
  return array_of(of_each(plan.parameters, [](const PlannedParameter& p) { return p.sigma.value_or(nan); }));
}

void save(const Plan& plan, const py::object& path, bool overwrite) {
  const bool csv = path.cast<std::filesystem::path>().extension() == ".csv";
  if (csv && poses_csv(plan).empty()) throw InputError({}, "a plan of bare blocks has no poses for a CSV", "save JSON");
  save_text(path, csv ? poses_csv(plan) : plan_json(plan), overwrite);
}

void bind_plan_class(py::module_& m) {
  const auto each = [](auto value) { return [value](const Plan& p) { return of_each(p.poses, value); }; };
  const auto name_of = [](auto field) {
    return [field](const Plan& p) {
      return p.poses.empty() ? std::vector<std::string>() : of_each(p.poses.front().configuration, field);
    };
  };
  py::class_<Plan> bound(m, "Plan", py::dynamic_attr(),
                         "Which poses to measure, and how good the result will be; docs/plan-file.md.");
  // Of plan(…, validation=k), which sets it on its result.
  bound.attr("validation") = py::none();
  for (const ChoiceKey& key : choice_keys)
    bound.def_property_readonly((std::string(key.name) + "s").c_str(), each([key](const PlannedPose& p) {
                                  return text_or_none(label_of(p.choices, key.name));
                                }));
  bound.def_readonly("poses", &Plan::poses)
      .def_property_readonly(
          "configurations", [](const Plan& p) { return pose_configurations(p.poses); },
          "N × n, SI, without load cases and stations")
      .def_property_readonly("names", name_of(&NamedValue::name), "of the columns of configurations")
      .def_property_readonly("units", name_of(&NamedValue::unit), "of the columns of configurations")
      .def_property_readonly("candidates", each(&PlannedPose::candidate),
                             "zero-based index of each pose's candidate or block; None: found between them")
      .def_property_readonly(
          "contributions", [](const Plan& p) { return array_of(of_each(p.poses, &PlannedPose::contribution)); },
          "share of all information of each pose")
      .def_readonly("parameters", &Plan::parameters, "interest first, then nuisance, then dropped ones")
      .def_property_readonly("sigma", &sigma, "predicted 1σ of each of the parameters, SI; nan where dropped")
      .def_readonly("log_det", &Plan::log_det, "log det of the information, nuisance eliminated, SI")
      .def_readonly("log_det_full", &Plan::log_det_full, "the same with nuisance columns")
      .def_readonly("criterion", &Plan::criterion)
      .def_readonly("criterion_value", &Plan::criterion_value, "in its own terms")
      .def_property_readonly("indices", [](const Plan& p) { return indices_dict(p.indices); })
      .def_readonly("condition", &Plan::condition)
      .def_property_readonly(
          "certificate",
          [](const Plan& p) { return p.certificate.proved ? std::optional(p.certificate) : std::nullopt; },
          "None for criteria without a bound")
      .def_readonly("proved_optimal", &Plan::proved_optimal)
      .def_readonly("rho0", &Plan::rho0, "predicted position error at the test poses, m; None without test poses")
      .def_property_readonly("test_errors", [](const Plan& p) { return array_of(p.test_errors); })
      .def_readonly("interrupted", &Plan::interrupted, "Ctrl-C or the time limit ended the search early")
      .def_readonly("variant", &Plan::variant, "empty for a plan of bare blocks")
      .def_readonly("method", &Plan::method)
      .def_readonly("scaling", &Plan::scaling)
      .def_readonly("prior", &Plan::prior)
      .def_readonly("reserve", &Plan::reserve)
      .def_property_readonly(
          "robust_efficiency",
          [](const Plan& p) { return array_of(p.robust ? p.robust->efficiency : std::vector<double>()); },
          "Of each robot drawn from the tolerances, against its own best plan; empty where none were drawn.")
      .def_readonly("seed", &Plan::seed)
      .def_property_readonly("problem_file", [](const Plan& p) { return p.problem.file; })
      .def_property_readonly("problem_sha256", [](const Plan& p) { return p.problem.sha256; })
      .def("summary", &plan_summary, "The table that the command line prints.")
      .def(
          "to_json", [](const Plan& p) { return plan_json(p); }, "plan.json.")
      .def(
          "to_dict", [](const Plan& p) { return parsed(plan_json(p)); }, "plan.json as a dictionary.")
      .def("to_csv", &poses_csv, "poses.csv.")
      .def("save", &save, py::arg("path"), py::kw_only(), py::arg("overwrite") = false,
           "Writes plan.json, or poses.csv where the name ends in .csv. FileExistsError where there is a file, unless "
           "overwrite.")
      .def("__len__", [](const Plan& p) { return p.poses.size(); })
      .def("__repr__", [](const Plan& p) { return "<Plan: " + plan_line(p) + ">"; });
}

}  // namespace

std::vector<std::string> kept_parameters(const Plan& plan, const std::string& variant) {
  std::vector<std::string> names;
  for (const PlannedParameter& p : plan.parameters)
    if (p.sigma && p.variant == variant) names.push_back(p.label.name);
  return names;
}

void bind_plan(py::module_& m) {
  bind_parameter(m);
  bind_pose(m);
  bind_certificate(m);
  bind_plan_class(m);
}

}  // namespace posewright::python
