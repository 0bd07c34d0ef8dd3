#include <algorithm>
#include <regex>

#include "bindings.hpp"

namespace posewright::python {
namespace {

/// Options as the command line writes them, --time-limit, become arguments: time_limit=.
std::string in_python(const std::string& text) {
  static const std::regex option("--([a-z][a-z-]*)");
  std::string result;
  auto rest = text.cbegin();
  for (std::sregex_iterator match(text.begin(), text.end(), option), end; match != end; ++match) {
    result.append(rest, (*match)[0].first);
    std::string name = (*match)[1];
    std::replace(name.begin(), name.end(), '-', '_');
    result += name + "=";
    rest = (*match)[0].second;
  }
  return result.append(rest, text.cend());
}

}  // namespace

namespace {

/// True if the message begins with these keys already. Entries of lists are counted from 1 in messages and from 0 in
/// Python.
bool same_keys(const std::string& message, const std::string& keys) {
  std::size_t i = 0;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (keys[k] == '[') {
      if (i >= message.size() || message[i] != '[') return false;
      const std::size_t close = keys.find(']', k), end = message.find(']', i);
      if (close == std::string::npos || end == std::string::npos) return false;
      k = close;
      i = end + 1;
    } else if (i >= message.size() || message[i++] != keys[k]) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::string place_in_keys(const InputError& error, const std::string& file, const std::vector<std::string>& places) {
  const std::string text = error.what();
  const SourcePlace& place = error.place();
  if (places.empty() || place.file != file || place.line < 1 || std::size_t(place.line) > places.size()) return text;
  const std::string head = file + ":" + std::to_string(place.line) + ": ";
  const std::string rest = text.substr(head.size()), &keys = places[std::size_t(place.line) - 1];
  return file + ": " + (keys.empty() || same_keys(rest, keys) ? "" : keys + ": ") + rest;
}

void bind_errors(py::module_& m) {
  // Never destroyed: the interpreter is gone by then.
  static const py::object& input = *new py::object(py::exception<InputError>(m, "InputError", PyExc_ValueError));
  static const py::object& cannot = *new py::object(py::exception<CannotDo>(m, "CannotDo", PyExc_RuntimeError));
  input.attr("__doc__") = "Input that is wrong in itself: `file:line: what is wrong; what is allowed`.";
  cannot.attr("__doc__") = "A sound request that cannot be done: infeasible, unidentifiable, stopped.";
  py::register_exception_translator([](std::exception_ptr pointer) {
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const InputError& error) {
      const SourcePlace& place = error.place();
      py::object raised = input(py::str(in_python(error.what())));
      raised.attr("file") = place.file.empty() ? py::object(py::none()) : py::object(py::str(place.file));
      raised.attr("line") = place.line > 0 ? py::object(py::int_(place.line)) : py::object(py::none());
      PyErr_SetObject(input.ptr(), raised.ptr());
    } catch (const CannotDo& error) {
      PyErr_SetString(cannot.ptr(), in_python(error.what()).c_str());
    }
  });
}

}  // namespace posewright::python
