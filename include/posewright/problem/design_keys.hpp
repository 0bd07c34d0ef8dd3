#pragma once

#include <functional>
#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"

namespace posewright {

namespace yaml {
class Value;
}
struct DesignReading;

/// One key of the block `design` of a problem file. Reader, `set`, command line, Python, schema and pages are loops
/// over these rows.
struct DesignKey {
  std::string path;      ///< "design.require.accuracy"
  std::string option;    ///< its own option of the command line, without dashes; empty: `--set` alone
  std::string value;     ///< name of the value in help: "N|auto"; empty: the option takes none
  std::string schema;    ///< type, unit and range: members of a JSON Schema
  std::string standard;  ///< default as JSON; empty: none
  std::string help;      ///< one sentence
  std::function<void(const yaml::Value&, DesignReading&)> read;
  bool lists_poses = false;  ///< a file of poses; Python takes the poses themselves, too

  /// "require.accuracy"
  std::string name() const { return path.substr(path.find('.') + 1); }
};

/// Rows in the order of the pages; a mapping stands before its own keys.
const std::vector<DesignKey>& design_keys();
/// Throws InputError for a path that is none.
const DesignKey& design_key(const std::string& path);

/// Sets one key of the design: text as in the file, or a mapping or list in YAML's flow style. Files are relative to
/// the working directory. Later messages about the value name `said_by` ("--poses") in place of file and line. Throws
/// InputError as the reader does, also for a path that is none.
void set(Problem& problem, const std::string& path, const std::string& value, const std::string& said_by);
/// set() of the edits that are keys of the design, in their order; the others are for read_problem().
void set_design(Problem& problem, const KeyEdits& edits);

/// Whether the key is one of the block `design`.
bool is_of_design(const KeyEdit& edit);

}  // namespace posewright
