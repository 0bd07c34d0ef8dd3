#include <array>
#include <bit>
#include <cstddef>
#include <new>

#include "posewright/support/taylor_model.hpp"

namespace posewright {
namespace {

constexpr std::align_val_t line{64};
// Blocks have 2^k bytes, from a line up to these; larger ones, and more of a size, are the general allocator's.
constexpr std::size_t size_classes = 16, most_blocks = 512;

/// Blocks that one thread gave back, by size.
struct FreeBlocks {
  struct Stack {
    std::array<void*, most_blocks> blocks;
    std::size_t count = 0;
  };
  std::array<Stack, size_classes> of;

  FreeBlocks() = default;
  ~FreeBlocks();
};

// Blocks may be given back when the thread's own are gone already.
thread_local bool is_gone = false;
thread_local FreeBlocks free_blocks;

FreeBlocks::~FreeBlocks() {
  is_gone = true;
  for (Stack& stack : of)
    while (stack.count > 0) ::operator delete(stack.blocks[--stack.count], line);
}

std::size_t size_class(std::size_t bytes) { return std::size_t(std::bit_width((bytes == 0 ? 0 : bytes - 1) | 63U)); }

}  // namespace

void* take_lines(std::size_t bytes) {
  const std::size_t k = size_class(bytes);
  if (k >= size_classes) return ::operator new(bytes, line);
  if (!is_gone)
    if (FreeBlocks::Stack& stack = free_blocks.of[k]; stack.count > 0) return stack.blocks[--stack.count];
  return ::operator new (std::size_t{1} << k, line);
}

void give_back_lines(void* block, std::size_t bytes) {
  const std::size_t k = size_class(bytes);
  if (k < size_classes && !is_gone)
    if (FreeBlocks::Stack& stack = free_blocks.of[k]; stack.count < most_blocks) {
      stack.blocks[stack.count++] = block;
      return;
    }
  ::operator delete(block, line);
}

}  // namespace posewright
