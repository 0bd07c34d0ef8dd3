#include "triangle_files.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <unordered_map>

#include "posewright/support/random.hpp"
#include "posewright/support/read_number.hpp"

namespace posewright {
namespace {

constexpr std::size_t header = 80, record = 50;  // bytes of binary STL

/// Puts triangles of corners together, each place one vertex.
class Welder {
 public:
  void add(const std::array<Eigen::Vector3f, 3>& corners) {
    if (mesh_.triangles.size() == most_triangles_read)
      throw BadMesh("has more than " + std::to_string(most_triangles_read) + " triangles");
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = vertex(corners[k]);
    mesh_.triangles.push_back(triangle);
  }
  TriangleMesh take() { return std::move(mesh_); }

 private:
  struct Hash {
    std::size_t operator()(const std::array<std::uint32_t, 3>& key) const {
      return std::size_t(mix_bits(mix_bits(mix_bits(key[0]) ^ key[1]) ^ key[2]));
    }
  };

  int vertex(const Eigen::Vector3f& p) {
    if (!p.allFinite()) throw BadMesh("has a vertex that is not finite");
    // −0 and 0 are one place.
    const Eigen::Vector3f plain = p.array() + 0.0F;
    const auto [at, is_new] =
        known_.try_emplace({std::bit_cast<std::uint32_t>(plain.x()), std::bit_cast<std::uint32_t>(plain.y()),
                            std::bit_cast<std::uint32_t>(plain.z())},
                           int(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.emplace_back(plain.cast<double>());
    return at->second;
  }

  TriangleMesh mesh_;
  std::unordered_map<std::array<std::uint32_t, 3>, int, Hash> known_;
};

std::uint32_t count_of(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + header, sizeof count);
  return count;
}

TriangleMesh read_binary(std::string_view bytes) {
  const std::size_t count = count_of(bytes);
  if (count > most_triangles_read)
    throw BadMesh("claims " + std::to_string(count) + " triangles; at most " + std::to_string(most_triangles_read) +
                  " are read");
  if (bytes.size() < header + 4 + record * count)
    throw BadMesh("ends before its " + std::to_string(count) + " triangles do");
  Welder welder;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 12> numbers{};  // normal, three corners
    std::memcpy(numbers.data(), bytes.data() + header + 4 + record * i, sizeof numbers);
    welder.add({Eigen::Vector3f(numbers[3], numbers[4], numbers[5]),
                Eigen::Vector3f(numbers[6], numbers[7], numbers[8]),
                Eigen::Vector3f(numbers[9], numbers[10], numbers[11])});
  }
  return welder.take();
}

/// Words of a text, one after the other.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  /// Empty at the end.
  std::string_view next() {
    const auto first = text_.find_first_not_of(" \t\r\n\f\v");
    if (first == std::string_view::npos) return {};
    text_.remove_prefix(first);
    const std::string_view word = text_.substr(0, text_.find_first_of(" \t\r\n\f\v"));
    text_.remove_prefix(word.size());
    return word;
  }

  float number() {
    std::string_view word = next();
    if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
    float value = 0;
    const auto [end, code] = read_number(word.data(), word.data() + word.size(), value);
    // Smaller than a float can be is zero.
    if (code == std::errc::result_out_of_range && word.find("e-") != std::string_view::npos) return 0.0F;
    if (word.empty() || code != std::errc() || end != word.data() + word.size())
      throw BadMesh("has '" + std::string(word.substr(0, 20)) + "' where a number is expected");
    return value;
  }

  Eigen::Vector3f point() {
    const float x = number(), y = number(), z = number();
    return {x, y, z};
  }

 private:
  std::string_view text_;
};

TriangleMesh read_text(std::string_view bytes) {
  Welder welder;
  Words words(bytes);
  std::array<Eigen::Vector3f, 3> corners;
  std::size_t corner = 0;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "facet") corner = 0;
    if (word != "vertex") continue;
    if (corner == 3) throw BadMesh("has a facet with more than three corners");
    corners[corner++] = words.point();
    if (corner == 3) welder.add(corners);
  }
  return welder.take();
}

}  // namespace

TriangleMesh read_stl(std::string_view bytes) {
  // Binary files may begin with "solid" too: their size tells.
  const bool has_count = bytes.size() >= header + 4;
  if (has_count && bytes.size() == header + 4 + record * std::size_t(count_of(bytes))) return read_binary(bytes);
  if (bytes.starts_with("solid") && bytes.find("facet") != std::string_view::npos) return read_text(bytes);
  if (!has_count) throw BadMesh("is not an STL file");
  return read_binary(bytes);
}

namespace {

class ObjReader {
 public:
  TriangleMesh read(std::string_view text) {
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      line(text.substr(begin, end - begin));
      begin = end + 1;
    }
    for (const std::array<int, 3>& triangle : triangles_) {
      std::array<Eigen::Vector3f, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = points_[std::size_t(triangle[k])];
      welder_.add(corners);
    }
    return welder_.take();
  }

 private:
  void line(std::string_view text) {
    Words words(text);
    const std::string_view kind = words.next();
    if (kind == "v") points_.push_back(words.point());
    if (kind == "f") face(words);
  }

  void face(Words& words) {
    std::vector<int> corners;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) corners.push_back(index(word));
    for (std::size_t k = 2; k < corners.size(); ++k) triangles_.push_back({corners[0], corners[k - 1], corners[k]});
    if (triangles_.size() > most_triangles_read)
      throw BadMesh("has more than " + std::to_string(most_triangles_read) + " triangles");
  }

  /// "3", "3/1", "3//2", "-1": from one, or back from the last vertex so far.
  int index(std::string_view word) const {
    int number = 0;
    const std::string_view digits = word.substr(0, word.find('/'));
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const int count = int(points_.size());
    if (code != std::errc() || end != digits.data() + digits.size() || number == 0 || number > count || number < -count)
      throw BadMesh("has a face with corner '" + std::string(word.substr(0, 20)) + "' of " + std::to_string(count));
    return number > 0 ? number - 1 : count + number;
  }

  std::vector<Eigen::Vector3f> points_;
  std::vector<std::array<int, 3>> triangles_;
  Welder welder_;
};

}  // namespace

TriangleMesh read_obj(std::string_view text) { return ObjReader().read(text); }

}  // namespace posewright
