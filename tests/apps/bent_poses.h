#pragma once
/// Poses of a small cylinder as files: what tests of examples in the window share.

#include <cmath>
#include <filesystem>
#include <string>

#include "apps/samples/meshes.h"
#include "engine/io/io.h"

namespace sinew::test {

/// A cylinder of 442 vertices, bent in the plane of x and y by so many radians from end to end.
inline Shape bent_cylinder(double bend) {
  Shape out = samples::cylinder(20, 3, 16);
  if (bend == 0) return out;
  const double radius = 1.15 / bend;
  for (Vec3& p : out.positions) {
    const double angle = p.y() / radius, from = radius - p.x();
    p = Vec3(radius - from * std::cos(angle), from * std::sin(angle), p.z());
  }
  return out;
}

/// Twisted about y by so many radians from end to end.
inline Shape twisted_cylinder(double twist) {
  Shape out = bent_cylinder(0);
  for (Vec3& p : out.positions) {
    const double angle = twist * p.y() / 1.15;
    p = Vec3(p.x() * std::cos(angle) + p.z() * std::sin(angle), p.y(),
             p.z() * std::cos(angle) - p.x() * std::sin(angle));
  }
  return out;
}

/// FOLDER/rest.obj and FOLDER/poses/{bent,twisted}.obj.
inline void write_poses(const std::string& folder) {
  std::filesystem::create_directories(folder + "/poses");
  io::write(folder + "/rest.obj", bent_cylinder(0));
  io::write(folder + "/poses/bent.obj", bent_cylinder(1.2));
  io::write(folder + "/poses/twisted.obj", twisted_cylinder(1.5));
}

}  // namespace sinew::test
