#pragma once
/// The device of all gpu tests, under the validation layer with synchronization and queue-submit validation. Every run
/// of the program first proves that a planted hazard is caught; every test fails on any message; so does the end, where
/// leaked objects are told.

#include <gtest/gtest.h>

#include "engine/gpu/buffer.h"
#include "engine/gpu/offscreen.h"

namespace sinew::gpu {

const Device& test_device();

/// Two copies to the same bytes without a barrier, in one submit or in two; what the layer says of it.
std::vector<std::string> messages_of_planted_hazard(const Device& device, bool two_submits);

class GpuTest : public ::testing::Test {
 protected:
  void TearDown() override;
};

/// A sphere's points with their normals, evenly spread.
void sphere(std::size_t count, std::vector<Eigen::Vector3d>& points, std::vector<Eigen::Vector3d>& normals);

/// A scene without ground, looking along -z at a box of size 2 about the origin.
Scene plain_scene();

}  // namespace sinew::gpu
