#pragma once
/// PC2, the point cache of 3ds Max (also Blender, Maya, Houdini): little-endian; "POINTCACHE2" and a zero byte; int32
/// version 1; int32 points; float32 start, the frame of the first sample; float32 sampling, frames from sample to
/// sample; int32 samples; then for each sample x, y, z of each point as float32.
///
/// Read: all of it; sample i is frame start + i x sampling. Where those are no ascending whole numbers, frames are
/// counted from 1 and the shape's notes say so. A rate is not in the file: 24.
/// Written: points only. Start and sampling are kept where the frames are those that were read.
/// Refused (InputError): another magic or version, no points or samples, a file that is too short for its header.

#include "engine/io/sequence.h"

namespace sinew::io {

Shape read_pc2(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_pc2(const std::string& path, const Shape& shape, WriteReport& report);
Sequence open_pc2(std::shared_ptr<const ByteSource> bytes, const ReadOptions& options);
std::unique_ptr<FrameWriter> create_pc2(const std::string& path, const FrameWriterOptions& options);

}  // namespace sinew::io
