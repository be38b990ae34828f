#pragma once
/// Shapes with example poses: the vertices and faces of all poses of one correspond. Metres, y up.

#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::samples {

struct NamedShape {
  std::string name;
  Shape shape;
};

/// The foal in ten poses: strides to the left and right, head down and up, a hind leg lifted, kicking, rearing,
/// sitting, its head turned to the left and right. What stands on the ground does so in all of them.
std::vector<NamedShape> foal_poses();
/// With cells of another size.
std::vector<NamedShape> foal_poses(double cell);

/// The foal with its head down, turned by 140 degrees about y.
Shape foal_turned();

/// A straight tube along y, of radius 0.035 and length 2, its rings wide apart here and close together there: 612
/// vertices, as the helix of Froehlich and Botsch, Figure 6, has.
Shape tube();
/// The tube wound up along y to a helix of so many turns, radius 0.09 (three at most): each ring stays as it is, and
/// stands across the curve. All lengths along the curve stay.
Shape helix(double turns);

}  // namespace sinew::samples
