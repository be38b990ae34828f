#pragma once
/// Portraits: pictures of what is shown, as it was when they were asked for, drawn by a thread and a device of its own
/// while the window goes on: turntables, and the small pictures of recent files.

#include <memory>
#include <string>
#include <vector>

#include "apps/editor/background.h"
#include "engine/document/workspace.h"
#include "engine/gpu/scene.h"

namespace sinew::editor {

class Session;
struct View;
struct Coloring;

/// What is drawn, and how.
struct Portrait {
  std::shared_ptr<const Shape> input;
  std::vector<document::LayerResult> layers;  ///< that bend it
  std::vector<gpu::PointColor> colors;        ///< n
  bool own_colors = true;                     ///< splats have their own; else those above
  gpu::Look look;
  gpu::UpAxis up = gpu::UpAxis::Y;
  bool ground = true;
  double point_size = 2;                                      ///< pixels
  std::vector<std::pair<gpu::Camera, std::string>> pictures;  ///< from where, and the PNG it goes to
  int width = 1280, height = 720;
  bool validation = false;  ///< checks the use of Vulkan: what it finds is an error
};

/// What the window shows, without marks, handles and overlays, and no pictures yet.
Portrait portrait_of(const Session& session, const View& view, const Coloring& coloring, const gpu::Look& look);

/// Draws and writes its pictures in order; folders that are missing are made. `tell` gets the part that is done and
/// stops by false. Throws InputError, io::Cancelled.
void draw_portrait(const Portrait& portrait, const Tell& tell);

/// Where the small picture of a recent file is kept: $XDG_CACHE_HOME/sinew/pictures or ~/.cache/sinew/pictures, by the
/// file's absolute path; empty where neither is known.
std::string picture_path(const std::string& file);
/// Removes the pictures of all other files.
void forget_pictures(const std::vector<std::string>& but_of);

inline constexpr int recent_width = 288, recent_height = 192;  ///< of such a picture, pixels

}  // namespace sinew::editor
