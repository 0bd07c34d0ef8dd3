#include "posewright/support/result_store.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

std::string name_of(int k) { return sha256_hex(std::to_string(k)); }

std::string bytes_in(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

TEST(ResultStore, WhatIsKeptIsFoundInAFolderThatIsMade) {
  const TemporaryFolder folder;
  const FolderStore store(folder / "a/b");
  EXPECT_FALSE(store.find(name_of(1)));
  EXPECT_FALSE(fs::exists(folder / "a"));
  const std::string bytes("text\0with a zero\n", 17);
  store.keep(name_of(1), bytes);
  EXPECT_EQ(store.find(name_of(1)), bytes);
  EXPECT_FALSE(store.find(name_of(2)));
  EXPECT_EQ(fs::status(folder / "a/b").permissions(), fs::perms::owner_all);
  store.keep(name_of(1), "other");
  EXPECT_EQ(store.find(name_of(1)), "other");
}

TEST(ResultStore, AFileWithAnyByteOrTheEndMissingIsNoResult) {
  const TemporaryFolder folder;
  const FolderStore store(folder.path());
  store.keep(name_of(1), "numbers");
  const fs::path file = folder / (name_of(1) + ".result");
  const std::string whole = bytes_in(file);
  for (std::size_t k = 0; k < whole.size(); ++k) {
    std::string damaged = whole;
    damaged[k] = char(damaged[k] ^ 1);
    folder.write(file.filename(), damaged);
    EXPECT_FALSE(store.find(name_of(1))) << k;
    folder.write(file.filename(), whole.substr(0, k));
    EXPECT_FALSE(store.find(name_of(1))) << k;
    if (k == 0) continue;
    store.keep(name_of(1), "numbers");  // the beginning is still a result's
    EXPECT_EQ(store.find(name_of(1)), "numbers") << k;
  }
  // One result under another's name.
  folder.write(name_of(2) + ".result", whole);
  EXPECT_FALSE(store.find(name_of(2)));
}

TEST(ResultStore, OtherFilesAreNeverTouched) {
  const TemporaryFolder folder;
  const FolderStore store(folder.path(), 2000);
  const std::string mine = name_of(1) + ".result";
  folder.write(mine, "a letter");
  folder.write("plan.json", std::string(5000, '.'));
  const fs::path outside = folder.write("outside", "posewright result 1\n");
  fs::create_symlink(outside, folder / (name_of(2) + ".result"));
  fs::create_directory(folder / (name_of(3) + ".result"));
  for (int k = 1; k < 40; ++k) store.keep(name_of(k), std::string(400, 'x'));
  EXPECT_EQ(bytes_in(folder / mine), "a letter");
  EXPECT_EQ(bytes_in(folder / "plan.json").size(), 5000u);
  EXPECT_EQ(bytes_in(outside), "posewright result 1\n");
  EXPECT_TRUE(fs::is_directory(folder / (name_of(3) + ".result")));
  EXPECT_FALSE(store.find(name_of(1)));
}

TEST(ResultStore, TheOnesThatAreNotUsedForTheLongestGo) {
  const TemporaryFolder folder;
  const FolderStore store(folder.path(), 4000);
  const auto hours_old = [&](int k, int hours) {
    fs::last_write_time(folder / (name_of(k) + ".result"),
                        fs::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  const std::string bytes(1000 - 150, 'x');  // with its head a result is 1000 bytes
  for (int k = 1; k <= 4; ++k) store.keep(name_of(k), bytes);
  for (int k = 1; k <= 4; ++k) hours_old(k, 10 - k);
  ASSERT_TRUE(store.find(name_of(1)));  // and now it is the youngest
  store.keep(name_of(5), bytes);
  EXPECT_TRUE(store.find(name_of(1)));
  EXPECT_FALSE(store.find(name_of(2)));
  EXPECT_TRUE(store.find(name_of(3)));
  store.keep(name_of(6), std::string(1001, 'x'));  // more than a quarter
  EXPECT_FALSE(store.find(name_of(6)));
}

TEST(ResultStore, WhatAKilledWriterLeftGoesAfterAnHour) {
  const TemporaryFolder folder;
  const FolderStore store(folder.path());
  const fs::path old = folder.write(name_of(1) + ".result.aB12cD", "half"),
                 now = folder.write(name_of(2) + ".result.aB12cD", "half");
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(2));
  store.keep(name_of(3), "bytes");
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(now));
}

TEST(ResultStore, AFolderThatCannotBeMadeOrWrittenIsNoError) {
  const TemporaryFolder folder;
  folder.write("file", "");
  for (const fs::path& place : {folder / "file", folder / "file/below", fs::path("/proc/self/here"), fs::path()}) {
    const FolderStore store(place);
    store.keep(name_of(1), "bytes");
    EXPECT_FALSE(store.find(name_of(1))) << place;
  }
}

TEST(ResultStore, ManyWritersOfOneNameLeaveAWholeResult) {
  const TemporaryFolder folder;
  {
    std::vector<std::jthread> writers;
    for (int w = 0; w < 4; ++w)
      writers.emplace_back([&] {
        const FolderStore store(folder.path(), 100'000);
        for (int k = 0; k < 30; ++k) {
          const std::string bytes(10'000, 'x');
          store.keep(name_of(k % 3), bytes);
          const auto found = store.find(name_of(k % 3));
          EXPECT_EQ(found.value_or(bytes), bytes);
        }
      });
  }
  EXPECT_EQ(folder.count_files(), 3u);
}

TEST(ResultStore, TheFolderIsTheStatedOneElseTheUsersCache) {
  const auto with = [](const char* own, const char* xdg, const char* home) {
    for (const auto& [name, value] : {std::pair("POSEWRIGHT_CACHE", own), {"XDG_CACHE_HOME", xdg}, {"HOME", home}})
      value == nullptr ? ::unsetenv(name) : ::setenv(name, value, 1);
    return cache_folder();
  };
  const std::string before = std::getenv("HOME") == nullptr ? "" : std::getenv("HOME");
  EXPECT_EQ(with("/c", "/x", "/h"), "/c");
  EXPECT_EQ(with("off", "/x", "/h"), "");
  EXPECT_EQ(with("", "/x", "/h"), "");
  EXPECT_EQ(with(nullptr, "/x", "/h"), "/x/posewright");
  EXPECT_EQ(with(nullptr, "relative", "/h"), "/h/.cache/posewright");
  EXPECT_EQ(with(nullptr, nullptr, nullptr), "");
  with("off", nullptr, before.c_str());
}

TEST(ReadDigest, CountsNamesContentsAndOrderWhileItLives) {
  const TemporaryFolder folder;
  const fs::path a = folder.write("a", "1"), b = folder.write("b", "2");
  const auto digest = [](const std::vector<fs::path>& files) {
    const ReadDigest read;
    for (const fs::path& file : files) read_file(file);
    return read.hex();
  };
  const std::string both = digest({a, b});
  EXPECT_EQ(digest({a, b}), both);
  EXPECT_NE(digest({b, a}), both);
  EXPECT_NE(digest({a}), both);
  folder.write("a", "3");
  EXPECT_NE(digest({a, b}), both);
  folder.write("a", "2"), folder.write("b", "1");
  EXPECT_NE(digest({a, b}), both);
  // The same files of another folder.
  const TemporaryFolder other;
  EXPECT_EQ(digest({other.write("a", "1"), other.write("b", "2")}), both);
  // By a library.
  const auto by_library = [&] {
    const ReadDigest read;
    record_input(a);
    return read.hex();
  };
  const std::string of_library = by_library();
  folder.write("a", "5");
  EXPECT_NE(by_library(), of_library);
  // In parts: what they hold is not known.
  const ReadDigest read;
  FileReader reader(a);
  EXPECT_EQ(read.hex(), "");
}

TEST(BuildIdentity, IsThatOfTheProgramAtEveryCall) {
  EXPECT_GE(build_identity().size(), 8u);
  EXPECT_EQ(build_identity(), build_identity());
}

}  // namespace
}  // namespace posewright
