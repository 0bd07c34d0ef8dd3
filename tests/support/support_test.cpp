#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>

#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/random.hpp"
#include "posewright/support/sha256.hpp"
#include "posewright/support/text_file.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

TEST(Sha256, EqualsThePublishedVectors) {
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(InputError, TextIsPlaceThenWhatThenAllowed) {
  EXPECT_STREQ(InputError({"a.yaml", 3}, "wrong", "right").what(), "a.yaml:3: wrong; right");
  EXPECT_STREQ(InputError({"a.yaml", 0}, "wrong", "").what(), "a.yaml: wrong");
  EXPECT_STREQ(InputError({}, "wrong", "right").what(), "wrong; right");
}

TEST(WriteFileAtomically, ReplacesTheWholeFileAndLeavesNothingElse) {
  const TemporaryFolder folder;
  write_file_atomically(folder / "a", "first");
  write_file_atomically(folder / "a", "second");
  EXPECT_EQ(read_file(folder / "a"), "second");
  EXPECT_EQ(folder.count_files(), 1U);
}

TEST(WriteFileAtomically, FailureNamesTheFileAndLeavesNothing) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_file_atomically(folder / "no/such/folder", "x"), CannotDo);
  EXPECT_THROW(write_file_atomically(folder.path(), "x"), CannotDo);
  EXPECT_THROW(require_writable(folder / "no/such/folder"), CannotDo);
  require_writable(folder / "fine");
  EXPECT_EQ(folder.count_files(), 0U);
}

TEST(ReadFile, RefusesFoldersMissingAndOversizedFiles) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_file(folder.path()), InputError);
  EXPECT_THROW(read_file(folder / "missing"), InputError);
  EXPECT_THROW(read_file(folder.write("big", "123456"), 5), InputError);
}

TEST(ParallelFor, EveryIndexOnceOnAnyNumberOfThreads) {
  for (const int threads : {1, 2, 7}) {
    std::vector<std::atomic<int>> count(1000);
    parallel_for(1000, threads, [&](std::size_t i, int worker) {
      EXPECT_LT(worker, threads);
      ++count[i];
    });
    for (const auto& c : count) EXPECT_EQ(c, 1);
  }
}

TEST(ParallelFor, AnExceptionReachesTheCaller) {
  for (const int threads : {1, 3})
    EXPECT_THROW(parallel_for(100, threads,
                              [](std::size_t i, int) {
                                if (i == 42) throw std::runtime_error("x");
                              }),
                 std::runtime_error);
}

TEST(Random, StreamsDifferAndRepeat) {
  Random a(1, 0), b(1, 0), c(1, 1);
  EXPECT_EQ(a.bits(), b.bits());
  EXPECT_NE(a.bits(), c.bits());
  double mean = 0;
  for (int i = 0; i < 10000; ++i) mean += a.uniform() / 10000;
  EXPECT_NEAR(mean, 0.5, 0.02);
}

TEST(XmlText, IsConvertedFromWhatItDeclaresWhereverTheDeclarationIsThen) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string& bytes) {
    write_file_atomically(folder / "a.xml", bytes);
    return read_xml_text(folder / "a.xml", 1000);
  };
  EXPECT_EQ(read("<?xml version=\"1.0\" encoding='ISO-8859-1'?><a n=\"\xe4\"/>"),
            "<?xml version=\"1.0\" encoding='UTF-8'?><a n=\"\xc3\xa4\"/>");
  // Letters before the name become longer.
  EXPECT_EQ(read("<?xml \xe4\xe4 encoding='ISO-8859-1'?><a/>"), "<?xml \xc3\xa4\xc3\xa4 encoding='UTF-8'?><a/>");
  EXPECT_THROW(read(std::string("<?xml encoding='UTF-16\0\0'?>", 27)), InputError);
  EXPECT_THROW(read("<?xml encoding='ascii//IGNORE'?>"), InputError);
}

}  // namespace
}  // namespace posewright
