#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "posewright/support/error.hpp"

namespace posewright {

/// Values one after the other as the bytes of this kind of machine, for results that go to a log or to another process
/// of the same program.
class ByteWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void put(T value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void put(std::string_view text) {
    put(std::uint64_t(text.size()));
    bytes_.append(text);
  }
  void put(const std::string& text) { put(std::string_view(text)); }
  template <class T>
  void put(const std::vector<T>& values) {
    put(std::uint64_t(values.size()));
    for (const T& value : values) put(value);
  }
  void put(const Eigen::VectorXd& values) {
    put(std::uint64_t(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), std::size_t(values.size()) * sizeof(double));
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads the bytes of ByteWriter, in the same order. Throws CannotDo where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void get(T& value) { std::memcpy(&value, taken(sizeof value).data(), sizeof value); }
  void get(std::string& text) { text = std::string(taken(size())); }
  template <class T>
  void get(std::vector<T>& values) {
    // Nothing is taken for granted of a size: a value has a byte at least.
    const std::size_t count = size();
    if (count > rest_.size()) cut_short();
    values.resize(count);
    for (T& value : values) get(value);
  }
  void get(Eigen::VectorXd& values) {
    const std::size_t count = size();
    if (count > rest_.size() / sizeof(double)) cut_short();
    const std::string_view bytes = taken(count * sizeof(double));
    values.resize(Eigen::Index(count));
    std::memcpy(values.data(), bytes.data(), bytes.size());
  }
  template <class T>
  T get() {
    T value{};
    get(value);
    return value;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  [[noreturn]] static void cut_short() { throw CannotDo("the result of a task is cut short"); }
  std::size_t size() { return std::size_t(get<std::uint64_t>()); }
  std::string_view taken(std::size_t count) {
    if (count > rest_.size()) cut_short();
    const std::string_view part = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return part;
  }

  std::string_view rest_;
};

}  // namespace posewright
