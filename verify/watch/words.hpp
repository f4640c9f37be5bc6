// Where something stands, written down as 64-bit words and read back to the bit: what a checkpoint
// is made of.
//
// A class that has to be written down names its numbers once, for both ways:
//
//   template <class Words>
//   void serialize(Words& words) { words(sum_, lost_, step_); }
//
// Not taken: cereal and JSON's binary forms. The first believes any length that a damaged file
// names, the second keeps a ball of 10^7 particles five times in memory.
#pragma once

#include <bit>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernels/model/state.hpp"
#include "kernels/stepping/stepper.hpp"

namespace bounce {

/// Words that are not what was written.
class WordsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// FNV-1a, a word at a time: one word that is changed always changes the sum.
class Checksum {
 public:
  void add(std::uint64_t word) { sum_ = (sum_ ^ word) * 0x100000001b3U; }
  void add(std::span<const std::uint64_t> words) {
    for (const std::uint64_t word : words) add(word);
  }
  void add(std::string_view text) {
    for (const char c : text) add(std::uint64_t{static_cast<unsigned char>(c)});
  }
  [[nodiscard]] std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325U;
};

template <class Words>
void serialize(Words& words, State& state) {
  words(state.x, state.y, state.vx, state.vy);
}
template <class Words>
void serialize(Words& words, Snapshot& snapshot) {
  words(snapshot.state, snapshot.stage_held, snapshot.step, snapshot.own);
}

/// What may stand in one word.
template <class T>
concept OneWord = std::is_same_v<T, double> || std::is_integral_v<T> || std::is_enum_v<T>;

/// Writes numbers, enumerations, text, vectors, deques, optionals and what has a serialize().
class WordWriter {
 public:
  /// `sink` gets the words, some at a time.
  explicit WordWriter(std::function<void(std::span<const std::uint64_t>)> sink)
      : sink_(std::move(sink)) {}
  template <class... Parts>
  void operator()(const Parts&... parts) {
    (put(parts), ...);
  }
  /// Hands on what is left.
  void finish() {
    sink_(some_);
    some_.clear();
  }

 private:
  static constexpr std::size_t enough = 8192;  // words to be handed on at a time

  void put(const char& letter) { put_word(static_cast<unsigned char>(letter)); }
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_same_v<T, double>) {
      put_word(std::bit_cast<std::uint64_t>(value));
    } else if constexpr (OneWord<T>) {
      put_word(static_cast<std::uint64_t>(value));
    } else if constexpr (requires(T & t, WordWriter & w) { t.serialize(w); }) {
      const_cast<T&>(value).serialize(*this);  // which only reads, here
    } else {
      serialize(*this, const_cast<T&>(value));
    }
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put_all(values);
  }
  template <class T>
  void put(const std::deque<T>& values) {
    put_all(values);
  }
  void put(const std::string& text) { put_all(text); }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class Values>
  void put_all(const Values& values) {
    put(values.size());
    for (const auto& value : values) put(value);
  }
  void put_word(std::uint64_t word) {
    some_.push_back(word);
    if (some_.size() >= enough) finish();
  }

  std::function<void(std::span<const std::uint64_t>)> sink_;
  std::vector<std::uint64_t> some_;
};

/// Reads what a WordWriter wrote, in the same order. Throws WordsError where words are missing, or
/// cannot be what is asked for; it never reserves more than the words there are.
class WordReader {
 public:
  explicit WordReader(std::span<const std::uint64_t> words) : left_(words) {}
  template <class... Parts>
  void operator()(Parts&... parts) {
    (get(parts), ...);
  }
  /// Throws if words are left over.
  void finish() const {
    if (!left_.empty()) throw WordsError("there is more than belongs there");
  }

 private:
  std::uint64_t next() {
    if (left_.empty()) throw WordsError("it ends too early");
    const std::uint64_t word = left_.front();
    left_ = left_.subspan(1);
    return word;
  }
  void get(char& letter) {
    const std::uint64_t word = next();
    if (word > 0xff) throw WordsError("a number is out of range");
    letter = static_cast<char>(word);
  }
  template <class T>
  void get(T& value) {
    if constexpr (std::is_same_v<T, double>) {
      value = std::bit_cast<double>(next());
    } else if constexpr (OneWord<T>) {
      const std::uint64_t word = next();
      value = static_cast<T>(word);
      if (static_cast<std::uint64_t>(value) != word) throw WordsError("a number is out of range");
    } else if constexpr (requires(WordReader & r) { value.serialize(r); }) {
      value.serialize(*this);
    } else {
      serialize(*this, value);
    }
  }
  template <class T>
  void get(std::vector<T>& values) {
    get_all(values);
  }
  template <class T>
  void get(std::deque<T>& values) {
    get_all(values);
  }
  void get(std::string& text) { get_all(text); }
  template <class T>
  void get(std::optional<T>& value) {
    bool any = false;
    get(any);
    value.reset();
    if (any) get(value.emplace(T{}));  // (of a class within a class clang takes no empty emplace())
  }
  template <class Values>
  void get_all(Values& values) {
    const std::uint64_t size = next();
    if (size > left_.size()) throw WordsError("a list is longer than what is there");
    values.clear();
    values.resize(size);
    for (auto& value : values) get(value);
  }

  std::span<const std::uint64_t> left_;
};

}  // namespace bounce
