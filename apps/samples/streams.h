#pragma once
/// Particle streams: simulated fluid, frame by frame at 24 frames a second. Metres, y up, the floor at y = 0.
/// Attributes: velocity (metres a second, the central difference of the simulation's own steps) and id (kept for life;
/// particles stand in its order).

#include <array>
#include <functional>

#include "engine/geometry/shape.h"

namespace sinew::samples {

/// Takes frame 1, 2, 3 ...
using TakeFrame = std::function<void(int frame, const Shape& shape)>;

/// A jet that rises from a nozzle at the origin, falls in an arc towards +x and splashes on the floor 1.4 m away: about
/// 1,000 particles a frame, which are born in the nozzle and die about 1.2 s later.
void make_jet(int frames, const TakeFrame& take);

/// Two columns of water that were let go in opposite corners of a tank meet in its middle. A column has as many
/// particles along x, y and z as `column` says, the tank room for two and a half and two columns.
void make_dam_break(const std::array<int, 3>& column, int frames, const TakeFrame& take);

/// make_dam_break of 200,000 particles.
void make_splash(int frames, const TakeFrame& take);

}  // namespace sinew::samples
