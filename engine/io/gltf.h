#pragma once
/// glTF 2.0 (Khronos), .gltf and .glb: a mesh and its animation by morph targets. Y is up in glTF, metres are its unit;
/// coordinates are read and written as they are.
///
/// Read: the first mesh in the order of the scene's nodes. Points: the vertices of its primitives, in the order of the
/// file, those that several primitives share once; in the space of the scene, through the matrices of the nodes above.
/// Faces: triangles, strips and fans. Frames: the keys of the first animation of the node's weights; at a key the
/// position of a point is base + sum_k w_k target_k, whatever the interpolation, for all of them pass through their
/// keys. Frame numbers and rate are those of frame_times.h. Without such an animation one frame, with the weights of
/// node or mesh. Any type of component, normalized integers, interleaved and sparse accessors, buffers in the file, in
/// base64 or beside it. position_type is Float32, and Float64 where a node moves the mesh. Not read, and told by
/// Shape::notes: other meshes, normals, tangents, colours, texture coordinates, materials, skins, other animations,
/// points and lines.
///
/// Written: one node, one mesh of triangles (or points, where the shape has no faces); the first frame is the base
/// mesh, each further frame a morph target, and one animation with linear interpolation shows at the time of frame k,
/// frame / rate, frame k alone. A .gltf has its buffer in base64. Everything else that glTF could hold is not written:
/// attributes and, of a shape that was read from glTF, materials, names and other nodes are lost. Where all frames that
/// were read from one self-contained file are written unchanged to the same kind of file, its bytes are copied, and
/// nothing is lost.
///
/// Refused (InputError): another version, compressed geometry, indices and counts that name nothing, no mesh; for
/// writing, frames of another number of points or with other faces, times below zero, more than 4 GiB.

#include "engine/io/sequence.h"

namespace sinew::io {

Shape read_gltf(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);
Sequence open_gltf(std::shared_ptr<const ByteSource> bytes, const ReadOptions& options);

/// The base mesh with each morph target alone, in the target's own right; none where the file has none.
std::vector<std::shared_ptr<const Shape>> read_gltf_targets(const std::string& path);

std::vector<std::byte> write_gltf(const std::string& path, const Shape& shape, WriteReport& report);
std::vector<std::byte> write_glb(const std::string& path, const Shape& shape, WriteReport& report);
std::unique_ptr<FrameWriter> create_gltf(const std::string& path, const FrameWriterOptions& options);
std::unique_ptr<FrameWriter> create_glb(const std::string& path, const FrameWriterOptions& options);

}  // namespace sinew::io
