#include "apart_memory.hpp"

#include <algorithm>
#include <cmath>

namespace posewright {

ApartMemory& ApartMemory::of(const Scene& scene) {
  static thread_local ApartMemory memory;
  if (memory.scene_ != scene.number) memory.forget(scene);
  return memory;
}

void ApartMemory::forget(const Scene& scene) {
  scene_ = scene.number;
  const std::size_t places = scene.pairs.size() * std::size_t(scene.frames->poses_per_configuration());
  dimension_ = scene.pairs.empty() ? 0 : std::size_t(scene.pairs.front().approach.front().size());
  spare_.assign(places, never);
  states_.assign(places * dimension_, 0.0);
}

double ApartMemory::moved(const BodyPair& pair, std::size_t place, int pose, std::span<const double> q) const {
  const double *approach = pair.approach[std::size_t(pose)].data(), *then = states_.data() + place * dimension_;
  double sum = 0;
  for (std::size_t k = 0; k < dimension_; ++k) sum += approach[k] * std::abs(q[k] - then[k]);
  return sum;
}

void ApartMemory::keep(std::size_t place, std::span<const double> q, double spare) {
  spare_[place] = spare;
  std::copy_n(q.begin(), dimension_, states_.begin() + std::ptrdiff_t(place * dimension_));
}

}  // namespace posewright
