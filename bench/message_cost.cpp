// mpicxx -O2 -std=c++20 bench/message_cost.cpp -o message_cost; mpirun -n 2 message_cost
// Prints microseconds: of a message of 64 bytes on its way (half of there and back), and of the work for one that is
// received, as src/processes does it (look, size, take), and sent; and of a megabyte of a long message.
// The least of several repeats: other programs of the machine only add. bench/processes.py simulates with them.
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

namespace {

constexpr int rounds = 1000, repeats = 40, size = 64;

bool look(int from, MPI_Status& status) {
  int there = 0;
  MPI_Iprobe(from, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
  return there != 0;
}

void take(int from) {
  std::array<char, size> bytes;
  MPI_Status status;
  while (!look(from, status)) continue;
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  MPI_Recv(bytes.data(), count, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

void give(int to) {
  std::array<char, size> bytes{};
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Isend(bytes.data(), size, MPI_BYTE, to, 1, MPI_COMM_WORLD, &request);
  for (int gone = 0; gone == 0;) MPI_Test(&request, &gone, MPI_STATUS_IGNORE);
}

double there_and_back(int rank) {
  const double begin = MPI_Wtime();
  for (int i = 0; i < rounds; ++i) {
    if (rank == 0) give(1);
    take(1 - rank);
    if (rank == 1) give(0);
  }
  return (MPI_Wtime() - begin) / rounds;
}

/// Of a message that has come already: several are sent before the first is taken.
void work(int rank, double& receiving, double& sending) {
  constexpr int at_once = 50;
  receiving = sending = 0;
  for (int i = 0; i < rounds / at_once; ++i) {
    const double begin = MPI_Wtime();
    if (rank == 1)
      for (int k = 0; k < at_once; ++k) give(0);
    sending += MPI_Wtime() - begin;
    MPI_Barrier(MPI_COMM_WORLD);
    const double come = MPI_Wtime();
    if (rank == 0)
      for (int k = 0; k < at_once; ++k) take(1);
    receiving += MPI_Wtime() - come;
    MPI_Barrier(MPI_COMM_WORLD);
  }
  receiving /= rounds;
  sending /= rounds;
  MPI_Bcast(&sending, 1, MPI_DOUBLE, 1, MPI_COMM_WORLD);
}

/// Seconds for a million bytes of a long message.
double long_message(int rank) {
  constexpr int million = 1000000, count = 4, sendings = 2;
  static std::vector<char> bytes(std::size_t(count) * million);
  MPI_Barrier(MPI_COMM_WORLD);
  const double begin = MPI_Wtime();
  for (int i = 0; i < sendings; ++i) {
    if (rank == 1) MPI_Send(bytes.data(), int(bytes.size()), MPI_BYTE, 0, 2, MPI_COMM_WORLD);
    else MPI_Recv(bytes.data(), int(bytes.size()), MPI_BYTE, 1, 2, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  return (MPI_Wtime() - begin) / (count * sendings);
}

double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

}  // namespace

int main(int count, char** arguments) {
  MPI_Init(&count, &arguments);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::vector<double> ways, received, sent, millions;
  for (int i = 0; i < repeats; ++i) {
    ways.push_back(there_and_back(rank) / 2);
    double receiving = 0, sending = 0;
    work(rank, receiving, sending);
    received.push_back(receiving);
    sent.push_back(sending);
    millions.push_back(long_message(rank));
  }
  if (rank == 0)
    std::printf("way %.3f received %.3f sent %.3f megabyte %.1f\n", 1e6 * least(ways), 1e6 * least(received),
                1e6 * least(sent), 1e6 * least(millions));
  MPI_Finalize();
}
