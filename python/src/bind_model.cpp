#include <pybind11/stl.h>

#include "bindings.hpp"
#include "keywords.hpp"
#include "posewright/support/error.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright::python {
namespace {

std::unique_ptr<GivenModel> make_model(std::shared_ptr<GivenProblem> problem, const std::string& variant,
                                       std::vector<std::string> parameters, const py::object& candidates,
                                       const py::int_& seed, long long threads, py::object progress) {
  VariantOptions options;
  options.variant = variant;
  options.parameters = std::move(parameters);
  options.candidates =
      optional_number(candidates, "candidates", most_candidates).value_or(problem->problem.design.candidates.value);
  options.seed = seed_of(seed);
  options.threads = checked("threads", threads, 0, most_threads);
  auto made = std::make_unique<GivenModel>();
  made->problem = std::move(problem);
  Watch watch({}, std::move(progress));
  watch.run(
      [&](const Monitor& monitor) {
        made->variant =
            with_places(*made->problem, [&] { return make_variant(made->problem->problem, options, monitor); });
      },
      OnInterrupt::raise);
  return made;
}

/// Parameters that a plan identified, so that its figures follow from the blocks.
std::unique_ptr<GivenModel> model_of_plan(std::shared_ptr<GivenProblem> problem, const Plan& plan, std::string variant,
                                          long long threads) {
  if (variant.empty()) {
    if (!plan.variants.empty())
      throw InputError({}, "the plan serves several variants: " + plan.variant, "name one with variant=");
    variant = plan.variant;
  }
  std::vector<std::string> kept = kept_parameters(plan, plan.variants.empty() ? "" : variant);
  if (kept.empty()) throw InputError({}, "the plan has no parameters of variant '" + variant + "'", "");
  return make_model(std::move(problem), variant, std::move(kept), py::none(), py::int_(0), threads, py::none());
}

Configurations configurations_of(const GivenModel& model, const py::object& poses) {
  const std::vector<Coordinate>& coordinates = model.variant.workspace->coordinates();
  Configurations result;
  result.dimension = int(coordinates.size());
  for (const auto& q : pose_list(poses, coordinates).configurations)
    result.values.insert(result.values.end(), q.begin(), q.end());
  return result;
}

py::array_t<double> configuration_array(const Configurations& list) {
  return py::array_t<double>({py::ssize_t(list.count()), py::ssize_t(list.dimension)}, list.values.data());
}

Blocks blocks_at(const GivenModel& model, const py::object& poses, long long threads) {
  const int workers = checked("threads", threads, 0, most_threads);
  const Configurations list = configurations_of(model, poses);
  const VariantColumns& columns = model.variant.columns;
  const py::gil_scoped_release release;
  return {std::make_shared<BlockArray>(build_blocks(*model.variant.model, columns.selected, list, workers)),
          columns.parameters, columns.nuisance};
}

Blocks blocks_of_problem(std::shared_ptr<GivenProblem> problem, const py::object& poses, const std::string& variant,
                         long long threads) {
  const auto model = py::isinstance<Plan>(poses)
                         ? model_of_plan(std::move(problem), poses.cast<const Plan&>(), variant, threads)
                         : make_model(std::move(problem), variant, {}, py::none(), py::int_(0), threads, py::none());
  return blocks_at(*model, poses, threads);
}

py::tuple jacobians(const GivenModel& model, const py::object& poses) {
  const Configurations list = configurations_of(model, poses);
  const auto n = py::ssize_t(list.count()), r = py::ssize_t(model.variant.model->rows()),
             m = py::ssize_t(model.variant.columns.selected.size());
  py::array_t<double> G({n, r, m}), covariance({n, r, r});
  auto g = G.mutable_unchecked<3>(), c = covariance.mutable_unchecked<3>();
  Linearisation linearisation;
  for (py::ssize_t i = 0; i < n; ++i) {
    if (!model.variant.model->linearise(list[std::size_t(i)], {}, model.variant.columns.selected, linearisation))
      throw CannotDo("configuration " + std::to_string(i) + " is out of reach");
    for (py::ssize_t k = 0; k < r; ++k) {
      for (py::ssize_t j = 0; j < m; ++j) g(i, k, j) = linearisation.G(k, j);
      for (py::ssize_t j = 0; j < r; ++j) c(i, k, j) = linearisation.covariance(k, j);
    }
  }
  return py::make_tuple(G, covariance);
}

py::array_t<double> candidates(const GivenModel& model, long long count, const py::int_& seed, long long threads,
                               py::object progress) {
  SamplingOptions options;
  options.count = std::size_t(checked("count", count, 1, most_candidates));
  options.seed = seed_of(seed);
  options.threads = checked("threads", threads, 0, most_threads);
  Configurations drawn;
  Watch watch({}, std::move(progress));
  watch.run([&](const Monitor& monitor) { drawn = sample_configurations(*model.variant.workspace, options, monitor); },
            OnInterrupt::raise);
  return configuration_array(drawn);
}

void bind_coordinate(py::module_& m) {
  py::class_<Coordinate>(m, "Coordinate", "One entry of a configuration.")
      .def_readonly("name", &Coordinate::name)
      .def_readonly("unit", &Coordinate::unit, "rad or m; empty for a choice")
      .def_readonly("lower", &Coordinate::lower, "limit in force")
      .def_readonly("upper", &Coordinate::upper, "limit in force")
      .def_readonly("periodic", &Coordinate::periodic, "a full turn: the limits are no boundary")
      .def_readonly("values", &Coordinate::values, "the only values allowed; empty: all between the limits")
      .def_readonly("labels", &Coordinate::labels, "of a choice: what 0, 1, … stand for")
      .def("__repr__", [](const Coordinate& c) {
        return c.choice() ? py::str("<Coordinate {}: one of {}>").format(c.name, c.labels)
                          : py::str("<Coordinate {}: {:g} to {:g} {}>").format(c.name, c.lower, c.upper, c.unit);
      });
}

}  // namespace

void bind_model(py::module_& m) {
  bind_coordinate(m);
  py::class_<GivenModel>(m, "Model", R"(A variant of a problem, ready to give Jacobian blocks at any configuration.

Configurations are an array N × len(coordinates) in SI units (a choice as 0, 1, …; choices with one label may be left
out), the name of a pose list, or a Plan. For an `auto` variant so many candidates (as in the problem, where it is not
said) are drawn, and the columns are those of a plan from as many with the same seed; Model(problem, plan) draws none
and has exactly the plan's.)")
      .def(py::init(&make_model), py::arg("problem"), py::arg("variant") = "",
           py::arg("parameters") = std::vector<std::string>(), py::kw_only(), py::arg("candidates") = py::none(),
           py::arg("seed") = 0, py::arg("threads") = 0, py::arg("progress") = py::none())
      .def(py::init(&model_of_plan), py::arg("problem"), py::arg("plan"), py::arg("variant") = "", py::kw_only(),
           py::arg("threads") = 0)
      .def_property_readonly("variant", [](const GivenModel& g) { return g.variant.columns.name; })
      .def_property_readonly(
          "coordinates", [](const GivenModel& g) { return g.variant.workspace->coordinates(); },
          "What a configuration consists of, with the limits in force.")
      .def_property_readonly(
          "parameters", [](const GivenModel& g) { return of_each(g.variant.columns.parameters, unplanned); },
          "Labels of the columns, nuisance first.")
      .def_property_readonly(
          "nuisance", [](const GivenModel& g) { return g.variant.columns.nuisance; }, "How many columns are nuisance.")
      .def(
          "configurations",
          [](const GivenModel& g, const py::object& poses) { return configuration_array(configurations_of(g, poses)); },
          py::arg("poses"), "Any list of poses as an array with one column for each coordinate.")
      .def("blocks", &blocks_at, py::arg("configurations"), py::kw_only(), py::arg("threads") = 0,
           "Whitened blocks J = L⁻¹ G (covariance of the residual = L Lᵀ), so that the information is Σ JᵀJ.")
      .def("jacobians", &jacobians, py::arg("configurations"),
           "(G, covariance): identification Jacobians n × r × m, not whitened, and the covariance n × r × r of the "
           "residual.")
      .def("candidates", &candidates, py::arg("count") = default_candidates, py::kw_only(), py::arg("seed") = 0,
           py::arg("threads") = 0, py::arg("progress") = py::none(),
           "Feasible configurations, N × n: those that a plan with the same seed chooses from.")
      .def("__repr__", [](const GivenModel& g) {
        return "<Model of variant " + g.variant.columns.name + ": " +
               std::to_string(g.variant.columns.parameters.size()) + " parameters, " +
               std::to_string(g.variant.columns.nuisance) + " of them nuisance>";
      });
  m.def("blocks", &blocks_of_problem, py::arg("problem"), py::arg("configurations"), py::arg("variant") = "",
        py::kw_only(), py::arg("threads") = 0,
        R"(Whitened Jacobian blocks of a Plan, the name of a pose list, or an array N × n in SI units.

Of a Plan the columns are exactly those it identifies. For many calls make a Model once and call its blocks().)");
}

}  // namespace posewright::python
