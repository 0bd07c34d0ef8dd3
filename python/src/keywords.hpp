#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "posewright/options/option.hpp"
#include "posewright/study/run_options.hpp"

namespace posewright::python {

constexpr int most_candidates = 10'000'000, most_threads = 4096;

/// Throws InputError "NAME is VALUE; LOWER to UPPER is allowed".
int checked(const std::string& name, long long value, int lower, int upper);
/// None: not said; else 1 to `upper`.
std::optional<int> optional_number(const py::object& value, const std::string& name, int upper, int lower = 1);
/// From 0 up. Throws InputError for other numbers.
std::uint64_t seed_of(const py::object& value);

/// Keywords of a call: options of a command, keys of the design, seed, threads, time limit and progress. None, an empty
/// text and a flag that is false: not given.
class Keywords {
 public:
  explicit Keywords(const py::kwargs& given);

  py::object progress;

  /// An argument that has a place of its own in the call.
  void set(const char* name, const py::object& value) { rest_[name] = value; }
  /// The value of a keyword; None where it is not given.
  py::object take(const std::string& name);
  std::string text(const std::string& name);

  /// Options of the table, and seed and threads where the struct has them.
  template <class Options>
  void read(const OptionTable<Options>& table, Options& options) {
    table.read(options, [&](const OptionRow& row) { return given(row); });
    set_run(options, seed_, threads_);
  }
  bool flag(const std::string& name);
  std::optional<double> time_limit() { return take("time_limit").cast<std::optional<double>>(); }

  /// The problem with the keys of the design that are left; poses that are given as such (a Plan, the name of a file,
  /// an array) come into `run`. Throws TypeError for a keyword that is no key, InputError for a value that is wrong.
  /// @param taken  names of keys that the function has for itself
  std::shared_ptr<GivenProblem> designed(const GivenProblem& given, const std::vector<std::string>& taken,
                                         RunOptions& run);
  /// Throws TypeError if a keyword is left.
  void finish() const;

 private:
  std::optional<GivenOption> given(const OptionRow& row);

  std::uint64_t seed_ = 0;
  int threads_ = 0;
  py::dict rest_;
};

/// Documentation of a function as pybind11 writes it: the signature, text, help of each option. Options and keys of the
/// design are among the arguments that need their name.
/// @param before, after  arguments in front of the options and behind them
/// @param taken          names that options and keys of the design do not have here
std::string documentation(const std::string& name, const std::string& before, const std::vector<OptionRow>& options,
                          std::vector<std::string> taken, bool design, const std::string& after,
                          const std::string& result, const std::string& text);

/// A function with this documentation.
template <class Function, class... Arguments>
void define(py::module_& m, const char* name, Function function, const std::string& text,
            const Arguments&... arguments) {
  py::options options;
  options.disable_function_signatures();
  m.def(name, function, arguments..., text.c_str());
}

/// Runs the work under a Watch; what it throws names keys of a problem that was not a file.
template <class Work>
auto watched(const GivenProblem& given, std::optional<double> time_limit, const py::object& progress,
             OnInterrupt on_interrupt, const Work& work) {
  decltype(work(std::declval<const Monitor&>())) result{};
  Watch watch(time_limit, progress);
  watch.run([&](const Monitor& monitor) { result = with_places(given, [&] { return work(monitor); }); }, on_interrupt);
  return result;
}

constexpr const char* run_arguments =
    ", seed: int = 0, threads: int = 0, time_limit: Optional[float] = None, progress: object = None";

}  // namespace posewright::python
