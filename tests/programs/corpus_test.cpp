// Programs in the style in which people write them, from general knowledge of the languages. Accounts were written by
// the program and read line by line: every motion and point keeps the treatment that is in the .account file, "line
// what: C|L|N|?" for compensated, left, not compensated, not understood.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "posewright/programs/program_document.hpp"
#include "posewright/support/file.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

const fs::path corpus = fs::path(POSEWRIGHT_SOURCE_DIR) / "tests/programs/corpus";

ProgramRobot robot_of(const std::string& format) {
  ProgramRobot robot{{"j1", "j2", "j3", "j4", "j5", "j6"}, std::vector<std::string>(6, "rad"), {}, {}};
  if (format != "urscript" && format != "kuka-krl" && format != "staubli-val3") robot.coupling = 0;
  if (format == "yaskawa-inform")
    robot.frames = {{{"1", {10, 0, 250, 0, 45, 0}}}, {{"1", {900, -200, 350, 5, -3, 12}}}};
  robot.settings.pulses_per_degree = std::vector<double>(6, 1000);
  return robot;
}

/// A program that stands in one file, or in a folder of several.
std::vector<ProgramFile> files_of(const std::string& format, const fs::path& program) {
  std::vector<fs::path> paths = {program};
  if (fs::is_directory(program)) {
    paths.clear();
    for (const auto& entry : fs::directory_iterator(program))
      if (entry.path().extension() != ".account") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
  }
  std::vector<ProgramFile> files;
  for (const fs::path& path : paths) files.push_back({format, read_file(path, 1'000'000), path.string()});
  return files;
}

std::string account_text(const std::vector<std::unique_ptr<ProgramDocument>>& documents) {
  std::ostringstream text;
  for (const auto& document : documents) {
    if (documents.size() > 1) text << fs::path(document->account().file).filename().string() << "\n";
    for (const ProgramEntry& entry : document->account().entries)
      text << entry.line << " " << entry.what << ": "
           << "CLN?"[int(entry.treatment)] << "\n";
  }
  return text.str();
}

TEST(Corpus, OfEveryLanguageHasItsAccount) {
  const std::map<std::string, std::string> languages = {{"krl", "kuka-krl"},          {"rapid", "abb-rapid"},
                                                        {"tp", "fanuc-tp"},           {"urscript", "urscript"},
                                                        {"inform", "yaskawa-inform"}, {"val3", "staubli-val3"}};
  for (const auto& [folder, format] : languages) {
    int programs = 0;
    for (const auto& entry : fs::directory_iterator(corpus / folder)) {
      if (entry.path().extension() == ".account") continue;
      ++programs;
      const auto documents = read_programs(files_of(format, entry.path()), robot_of(format));
      EXPECT_EQ(account_text(documents), read_file(entry.path().string() + ".account", 100'000)) << entry.path();
    }
    EXPECT_GE(programs, 10) << folder;
  }
}

/// What is written is the same program: read again, all points have the other values, and the same account.
TEST(Corpus, IsWrittenAndReadAgainWithOtherValues) {
  for (const auto& [folder, format] : std::map<std::string, std::string>{{"krl", "kuka-krl"},
                                                                         {"rapid", "abb-rapid"},
                                                                         {"tp", "fanuc-tp"},
                                                                         {"urscript", "urscript"},
                                                                         {"inform", "yaskawa-inform"},
                                                                         {"val3", "staubli-val3"}})
    for (const auto& entry : fs::directory_iterator(corpus / folder)) {
      if (entry.path().extension() == ".account") continue;
      std::vector<ProgramFile> files = files_of(format, entry.path());
      const auto before = read_programs(files, robot_of(format));
      for (std::size_t f = 0; f < files.size(); ++f) {
        std::vector<std::optional<ProgramDocument::Values>> values;
        for (const ProgramDocument::Point& point : before[f]->points()) {
          values.emplace_back(ProgramDocument::Values{{point.joints}, point.X_BaseTip});
          for (double& value : values.back()->stand.joints) value += 0.01;
        }
        files[f].text = before[f]->text(values, "remark");
      }
      const auto after = read_programs(files, robot_of(format));
      for (std::size_t f = 0; f < files.size(); ++f) {
        ASSERT_EQ(after[f]->points().size(), before[f]->points().size()) << entry.path();
        ASSERT_EQ(after[f]->account().entries.size(), before[f]->account().entries.size()) << entry.path();
        for (std::size_t p = 0; p < after[f]->points().size(); ++p)
          for (std::size_t i = 0; i < after[f]->points()[p].joints.size(); ++i)
            EXPECT_NEAR(after[f]->points()[p].joints[i], before[f]->points()[p].joints[i] + 0.01, 2e-5) << entry.path();
      }
    }
}

}  // namespace
}  // namespace posewright
