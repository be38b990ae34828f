#pragma once
/// SharedArrays: the long arrays of many versions of a project, each once, by numbers from 0. What was not edited has
/// the same number in all of them, so that a version costs little where it is written down.

#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>

#include "engine/document/project.h"

namespace sinew::document {

class SharedArrays {
 public:
  using Array = std::variant<Shared<Index>, Shared<Vec3>, Shared<Affine>>;

  /// Arrays of no more elements stay in the text.
  static constexpr std::size_t longest_in_text = 64;

  /// That of the array with this content; a new one where there is none yet.
  template <class T>
  std::size_t number_of(const Shared<T>& array) {
    const auto known = by_address_.find(array.get().data());
    if (known != by_address_.end()) return known->second;
    const std::size_t hash = std::hash<std::string_view>{}(bytes_of(array));
    for (auto [same, end] = by_hash_.equal_range(hash); same != end; ++same)
      if (const Shared<T>* found = std::get_if<Shared<T>>(&arrays_[same->second]);
          found != nullptr && bytes_of(*found) == bytes_of(array))
        return same->second;
    by_hash_.emplace(hash, arrays_.size());
    return add(array);
  }

  /// Under the next number.
  template <class T>
  std::size_t add(const Shared<T>& array) {
    by_address_.emplace(array.get().data(), arrays_.size());
    arrays_.emplace_back(array);
    return arrays_.size() - 1;
  }

  std::size_t size() const { return arrays_.size(); }
  const Array& at(std::size_t number) const { return arrays_[number]; }

  /// The array of a number in decimal; null where there is none, or one of other elements.
  template <class T>
  const Shared<T>* find(const std::string& number) const {
    std::size_t value = 0;
    if (number.empty() || number.size() > 12) return nullptr;
    for (const char c : number) {
      if (c < '0' || c > '9') return nullptr;
      value = 10 * value + static_cast<std::size_t>(c - '0');
    }
    return value < arrays_.size() ? std::get_if<Shared<T>>(&arrays_[value]) : nullptr;
  }

  /// The elements as they lie in memory: whole numbers and doubles without gaps.
  template <class T>
  static std::string_view bytes_of(const Shared<T>& array) {
    static_assert(sizeof(Vec3) == 24 && sizeof(Affine) == 96);
    return {reinterpret_cast<const char*>(array.get().data()), array.get().size() * sizeof(T)};
  }

 private:
  std::vector<Array> arrays_;  ///< holds them, so that no address is used again
  std::unordered_map<const void*, std::size_t> by_address_;
  std::multimap<std::size_t, std::size_t> by_hash_;
};

}  // namespace sinew::document
