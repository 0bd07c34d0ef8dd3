#include "tree.hpp"

#include <algorithm>
#include <limits>
#include <thread>

#include "posewright/support/bytes.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr int along_the_tree = 4;  // tag; 1 to 3: mpi_workers.cpp

}  // namespace

void wait_until(const std::function<bool()>& there) {
  constexpr int looks_at_once = 200, part = 8;
  const auto begin = std::chrono::steady_clock::now();
  for (int looks = 1; !there(); ++looks) {
    if (looks < looks_at_once) continue;
    const auto waited = std::chrono::steady_clock::now() - begin;
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(waited / part, longest_pause));
  }
}

void wait(MPI_Request& request) {
  wait_until([&] {
    int there = 0;
    MPI_Test(&request, &there, MPI_STATUS_IGNORE);
    return there != 0;
  });
}

std::string received(const MPI_Status& status) {
  int size = 0;
  MPI_Get_count(&status, MPI_BYTE, &size);
  std::string message(std::size_t(size), '\0');
  MPI_Recv(message.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return message;
}

void Tree::send(const std::string& bytes, int to) {
  if (bytes.size() > std::size_t(std::numeric_limits<int>::max()))
    throw CannotDo("a message of " + std::to_string(bytes.size()) + " bytes is more than MPI sends at once");
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Isend(bytes.data(), int(bytes.size()), MPI_BYTE, to, along_the_tree, MPI_COMM_WORLD, &request);
  wait(request);
  ++own_.messages;
  own_.bytes += long(bytes.size());
}

std::string Tree::receive(int from) {
  MPI_Status status;
  wait_until([&] {
    int there = 0;
    MPI_Iprobe(from, along_the_tree, MPI_COMM_WORLD, &there, &status);
    return there != 0;
  });
  ++own_.messages;
  std::string bytes = received(status);
  own_.bytes += long(bytes.size());
  return bytes;
}

void Tree::share(int from, std::string& bytes) {
  const int place = (rank_ - from + processes_) % processes_;
  int step = 1;
  while (step < processes_ && (place & step) == 0) step *= 2;
  if (place != 0) bytes = receive((rank_ - step + processes_) % processes_);
  for (step /= 2; step > 0; step /= 2)
    if (place + step < processes_) send(bytes, (rank_ + step) % processes_);
  all_.messages += processes_ - 1;
  all_.bytes += long(bytes.size()) * (processes_ - 1);
}

void Tree::combine(std::string& bytes, const Join& join) {
  // Each message begins with the bytes of those before it, so that the first process knows how many there were.
  long before = 0;
  for (int step = 1; step < processes_; step *= 2) {
    if ((rank_ & step) != 0) {
      ByteWriter message;
      message.put(before + long(bytes.size() + sizeof before));
      send(message.take() + bytes, rank_ - step);
      break;
    }
    if (rank_ + step >= processes_) continue;
    const std::string higher = receive(rank_ + step);
    before += ByteReader(higher).get<long>();
    bytes = join(bytes, std::string_view(higher).substr(sizeof before));
  }
  all_.messages += processes_ - 1;
  all_.bytes += before;
  share(0, bytes);
}

}  // namespace posewright
