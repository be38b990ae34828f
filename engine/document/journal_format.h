#pragma once
/// The records of a journal as bytes. Numbers are little-endian.
///
///   kind  content
///   1 a  an array: its elements as they lie in memory; a is 1 whole numbers (4 bytes), 2 places (3 doubles), 3 maps
///   (12) 2    a state: its index (8 bytes), the label's length (8), the label, and the project as JSON (edit.h), where
///   a long
///        array is the number of its record; what was at this index and behind it is gone, and it is the present one
///   3    the index of the present state (8)
///   4    the index of the state that is saved (8; 2^64 - 1: none), and the path of the edit's file
///   5    the hashes of the inputs, a line each

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/document/history.h"
#include "engine/document/shared_arrays.h"

namespace sinew::document::journal {

inline constexpr std::string_view magic = "sinew journal 1\n";
inline constexpr std::size_t head = 16;  ///< bytes of length and checksum
enum class Kind : std::uint8_t { Array = 1, State, Present, Saved, Hashes };
inline constexpr std::uint64_t none = ~std::uint64_t{0};

/// Each appends records to `out`. That of a state is preceded by arrays that `arrays` did not have.
void put_state(std::vector<std::byte>& out, SharedArrays& arrays, std::uint64_t index, const History::State& state);
void put_present(std::vector<std::byte>& out, std::uint64_t index);
void put_saved(std::vector<std::byte>& out, std::uint64_t index, const std::string& path);
void put_hashes(std::vector<std::byte>& out, const std::vector<std::string>& hashes);

}  // namespace sinew::document::journal
