#pragma once
/// The sample animal with any number of points, for tests of size: made and written block by block.

#include <cstdint>
#include <string>

namespace sinew::samples {

/// Writes a binary PLY of exactly `points` points (float x, y, z, and with `normals` nx, ny, nz) on the animal's
/// surface, without noise or holes, over what was at `path`. Memory does not grow with the number of points. Point i is
/// the same whatever their number. Throws InputError where the file cannot be written.
void write_dense_animal(const std::string& path, std::uint64_t points, bool normals, std::uint64_t seed = 1);

}  // namespace sinew::samples
