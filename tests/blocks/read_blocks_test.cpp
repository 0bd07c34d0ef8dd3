#include "posewright/blocks/read_blocks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "posewright/support/error.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

std::string npy(const std::string& header, const std::vector<double>& values) {
  std::string text = header;
  while ((10 + text.size() + 1) % 64 != 0) text += ' ';
  text += '\n';
  std::string bytes = "\x93NUMPY";
  bytes += std::string("\x01\x00", 2);
  bytes += char(text.size() % 256);
  bytes += char(text.size() / 256);
  bytes += text;
  const std::size_t at = bytes.size();
  bytes.resize(at + 8 * values.size());
  if (!values.empty()) std::memcpy(bytes.data() + at, values.data(), 8 * values.size());
  return bytes;
}

std::string header(const std::string& shape, const std::string& kind = "<f8", const std::string& fortran = "False") {
  return "{'descr': '" + kind + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }";
}

TEST(ReadBlocks, ThreeDimensionalArrayBecomesBlocks) {
  const TemporaryFolder folder;
  const BlockFile file =
      read_blocks(folder.write("b.npy", npy(header("(2, 2, 3)"), {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12})), {});
  EXPECT_EQ(file.blocks.count(), 2U);
  EXPECT_EQ(file.blocks.rows(), 2);
  EXPECT_EQ(file.blocks.columns(), 3);
  EXPECT_EQ(file.blocks.block(1)(1, 2), 12);
  EXPECT_EQ(file.blocks.row(1, 1)[3], 0) << "padding is zero";
  EXPECT_EQ(file.sha256.size(), 64U);
}

TEST(ReadBlocks, TwoDimensionalArrayIsCutIntoBlocksOfRows) {
  const TemporaryFolder folder;
  const auto path = folder.write("b.npy", npy(header("(4, 1)"), {1, 2, 3, 4}));
  const BlockFile file = read_blocks(path, 2);
  EXPECT_EQ(file.blocks.count(), 2U);
  EXPECT_EQ(file.blocks.block(1)(0, 0), 3);
  EXPECT_THROW(read_blocks(path, {}), InputError);
}

TEST(ReadBlocks, CsvWithHeaderNamesColumns) {
  const TemporaryFolder folder;
  const BlockFile file = read_blocks(folder.write("b.csv", "# comment\npx, py\n1,2\r\n3,-4e-1\n\n+5,6\n7,8\n"), 2);
  EXPECT_EQ(file.columns, (std::vector<std::string>{"px", "py"}));
  EXPECT_EQ(file.blocks.count(), 2U);
  EXPECT_EQ(file.blocks.block(0)(1, 1), -0.4);
}

TEST(ReadBlocks, SharesOfAnyNumberOfProcessesAreTheWholeFileInItsOrder) {
  const TemporaryFolder folder;
  constexpr std::size_t total = 1000;
  std::vector<double> numbers(total * 2 * 3);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = double(i);
  const auto path = folder.write("b.npy", npy(header("(1000, 2, 3)"), numbers));
  const BlockFile whole = read_blocks(path, {});
  for (const int processes : {1, 2, 3, 7, 40}) {
    std::size_t next = 0;
    for (int rank = 0; rank < processes; ++rank) {
      const BlockShare share = read_block_share(path, {}, rank, processes, 4);
      EXPECT_EQ(share.first, next);
      EXPECT_EQ(share.total, total);
      EXPECT_EQ(share.blocks.count(), share.count + 4);
      EXPECT_EQ(share.sha256, rank == 0 ? whole.sha256 : "");
      for (std::size_t i = 0; i < share.count; ++i)
        EXPECT_EQ(share.blocks.block(i), whole.blocks.block(next + i)) << processes << " processes, " << rank;
      next += share.count;
    }
    EXPECT_EQ(next, total);
  }
  EXPECT_THROW(read_block_share(folder.write("t.csv", "1,2\n3,4\n"), 1, 0, 2, 0), InputError);
}

struct Bad {
  const char* what;
  std::string bytes;
  std::optional<int> rows;
  const char* expected;
};

TEST(ReadBlocks, EveryMalformedFileGivesOneLineThatSaysWhy) {
  const std::vector<double> six = {1, 2, 3, 4, 5, 6};
  const std::vector<Bad> table = {
      {"empty", "", {}, "is empty"},
      {"no rows", "1,2\n3,4\n", {}, "--rows"},
      {"rows do not divide", "1\n2\n3\n", 2, "multiple of --rows 2"},
      {"rows zero", "1\n2\n", 0, "at least 1"},
      {"ragged", "1,2\n3\n", 1, ":2: has 1 columns; every row needs 2"},
      {"text cell", "1,2\n3,x\n", 1, ":2: 'x' is not a finite number"},
      {"nan cell", "1,2\n3,nan\n", 1, ":2: 'nan' is not a finite number"},
      {"inf first", "inf,2\n3,4\n", 1, ":1: 'inf' is not a finite number"},
      {"decimal comma as semicolons", "1;5\n", 1, "is not a finite number"},
      {"unit", "1 mm,2\n", 1, "has no rows"},
      {"empty cell", "1,\n", 1, "is not a finite number"},
      {"only header", "a,b\n", 1, "has no rows"},
      {"shape and --rows", npy(header("(1, 2, 3)"), six), 3, "--rows says 3"},
      {"too few numbers", npy(header("(2, 2, 3)"), six), {}, "are announced"},
      {"too many numbers", npy(header("(1, 1, 3)"), six), {}, "are announced"},
      {"one dimension", npy(header("(6,)"), six), {}, "1 dimensions"},
      {"zero blocks", npy(header("(0, 2, 3)"), {}), {}, "no blocks"},
      {"huge shape", npy(header("(1099511627776, 1099511627776, 8)"), six), {}, "announced"},
      {"endless shape", npy(header("(99999999999999999999999, 2, 3)"), six), {}, "no readable shape"},
      {"integers", npy(header("(1, 2, 3)", "<i8"), six), {}, "'<f8', '<f4'"},
      {"big endian", npy(header("(1, 2, 3)", ">f8"), six), {}, "'<f8', '<f4'"},
      {"fortran", npy(header("(1, 2, 3)", "<f8", "True"), six), {}, "Fortran"},
      {"no descr", npy("{'fortran_order': False, 'shape': (1, 2, 3)}", six), {}, "'descr'"},
      {"cut header", std::string("\x93NUMPY\x01\x00\xff\xff{", 11), {}, "cut off"},
      {"nan number", npy(header("(1, 2, 3)"), {1, 2, std::nan(""), 4, 5, 6}), {}, "row 0, column 2 is not finite"},
  };
  const TemporaryFolder folder;
  for (const Bad& bad : table) {
    const auto path = folder.write("bad", bad.bytes);
    try {
      read_blocks(path, bad.rows);
      ADD_FAILURE() << bad.what << " accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(bad.expected)) << bad.what;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << bad.what;
    }
  }
  EXPECT_THROW(read_blocks(folder / "missing.npy", {}), InputError);
  EXPECT_THROW(read_blocks(folder.path(), {}), InputError);
}

TEST(ReadBlocks, MutatedFilesAreReadOrRefusedButNeverCrash) {
  const TemporaryFolder folder;
  const std::vector<std::string> seeds = {npy(header("(2, 2, 3)"), std::vector<double>(12, 1.5)), "a,b\n1,2\n3,4\n"};
  Random random(1, 0);
  int read = 0, refused = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string bytes = seeds[std::size_t(i % 2)];
    for (int k = 1 + random.index(4); k > 0; --k) {
      const auto at = std::size_t(random.index(int(bytes.size())));
      if (random.index(3) == 0) bytes.erase(at, std::size_t(1 + random.index(8)));
      else bytes[at] = char(random.index(256));
      if (bytes.empty()) bytes = "x";
    }
    try {
      read_blocks(folder.write("m", bytes),
                  random.index(2) == 0 ? std::optional<int>(1 + random.index(3)) : std::nullopt);
      ++read;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(read, 10);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace posewright
