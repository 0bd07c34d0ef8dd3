#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace posewright {

/// Place of a value in a file; line is 1-based, 0 means the file as a whole. Column is that of a character, 1-based; 0:
/// it is not known.
struct SourcePlace {
  std::string file;
  int line = 0;
  int column = 0;
};

/// Input that is wrong in itself. The text reads `file:line: error; allowed` (without the parts that are unknown).
/// Programs end with exit status 2.
class InputError : public std::runtime_error {
 public:
  InputError(SourcePlace place, const std::string& what, const std::string& allowed);
  const SourcePlace& place() const { return place_; }

 private:
  SourcePlace place_;
};

/// A well-formed request that cannot be carried out: infeasible, unidentifiable, cannot write.
/// Programs end with exit status 1.
class CannotDo : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// No set of poses was found that identifies the parameters; another criterion may find one.
class NothingIdentifies : public CannotDo {
 public:
  using CannotDo::CannotDo;
};

/// A value together with the line (and column, if known) it was written on, for stages that can judge it only later.
template <class T>
struct Located {
  T value{};
  int line = 0;
  int column = 0;
};

}  // namespace posewright
