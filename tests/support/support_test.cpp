#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <stdexcept>

#include "posewright/support/distributions.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/random.hpp"
#include "posewright/support/sha256.hpp"
#include "posewright/support/text_file.hpp"
#include "src/support/sha256/blocks.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

#if defined(__x86_64__)
TEST(Sha256, IsTheSameByTheInstructionsOfTheProcessor) {
  if (!has_sha_instructions()) GTEST_SKIP() << "no such instructions here";
  Random random(3, 0);
  std::array<std::uint32_t, 64> constants;
  for (std::uint32_t& k : constants) k = std::uint32_t(random.uniform() * 4294967295.0);
  for (std::size_t blocks = 0; blocks < 5; ++blocks) {
    std::vector<unsigned char> bytes(64 * blocks);
    for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(random.index(256));
    std::array<std::uint32_t, 8> one{1, 2, 3, 4, 5, 6, 7, 0xffffffff}, other = one;
    compress_blocks(one.data(), bytes.data(), blocks, constants.data());
    compress_blocks_sha(other.data(), bytes.data(), blocks, constants.data());
    EXPECT_EQ(one, other) << blocks;
  }
}
#endif

TEST(Distributions, ResidualsOfZeroAreExceededForSure) {
  for (const double freedom : {1.0, 300.0, 400.0, 2000.0, 1e6})
    for (const double value : {0.0, 1e-300, 1e-15})
      // Below it are (value/2)^(freedom/2) / Γ(freedom/2 + 1) at most.
      EXPECT_NEAR(chi_square_exceeded(value, freedom), 1.0, 1e-7) << value << " " << freedom;
}

TEST(Sha256, EqualsThePublishedVectors) {
  // NIST, examples of FIPS 180-4: one block, none, two blocks, many.
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(
      sha256_hex(
          "abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopqklmnopqrlmnopqrsmnopqrst"
          "nopqrstu"),
      "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  EXPECT_EQ(sha256_hex(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, LengthsAboutABlockAreThoseOfHashlib) {
  const std::vector<std::pair<int, std::string>> known = {
      {55, "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318"},
      {56, "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a"},
      {63, "7d3e74a05d7db15bce4ad9ec0658ea98e3f06eeecf16b4c6fff2da457ddc2f34"},
      {64, "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb"},
      {119, "31eba51c313a5c08226adf18d4a359cfdfd8d2e816b13f4af952f7ea6584dcfb"},
      {1000, "41edece42d63e8d9bf515a9ba6932e1c20cbc9f5a5d134645adb5db1b9737ea3"}};
  for (const auto& [length, digest] : known)
    EXPECT_EQ(sha256_hex(std::string(std::size_t(length), 'a')), digest) << length;
}

TEST(Sha256, PiecesGiveWhatTheWholeGives) {
  std::string text;
  for (int k = 0; k < 300; ++k) text += char(k);
  for (std::size_t piece = 1; piece < 150; ++piece) {
    Sha256 hash;
    for (std::size_t at = 0; at < text.size(); at += piece) hash.add(std::string_view(text).substr(at, piece));
    EXPECT_EQ(hash.hex(), sha256_hex(text)) << piece;
  }
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
