#pragma once
/// MDD, the motion designer data of LightWave (also Blender, Modo, Houdini): big-endian; int32 frames; int32 points;
/// the time of each frame in seconds as float32; then for each frame x, y, z of each point as float32.
///
/// Read: all of it. Frame numbers and rate are those of frame_times.h; where the times give none, frames are counted
/// from 1 and the shape's notes say so.
/// Written: points only; the time of a frame is frame / rate. The times are kept where frames and rate are those that
/// were read.
/// Refused (InputError): no points or frames, a file that is too short for its header.

#include "engine/io/sequence.h"

namespace sinew::io {

Shape read_mdd(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
std::vector<std::byte> write_mdd(const std::string& path, const Shape& shape, WriteReport& report);
Sequence open_mdd(std::shared_ptr<const ByteSource> bytes, const ReadOptions& options);
std::unique_ptr<FrameWriter> create_mdd(const std::string& path, const FrameWriterOptions& options);

}  // namespace sinew::io
