#include <algorithm>
#include <filesystem>

#include "apps/editor/command_line.h"
#include "apps/editor/editor.h"
#include "apps/editor/export_notes.h"
#include "engine/geometry/error.h"
#include "engine/gpu/offscreen.h"
#include "engine/gpu/png.h"
#include "engine/io/control_points.h"
#include "engine/io/io.h"
#include "engine/io/motion.h"

namespace sinew::editor {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> extensions(bool written) {
  std::vector<std::string> out;
  for (const io::Format& format : io::formats())
    if (!written || format.write != nullptr) out.insert(out.end(), format.extensions.begin(), format.extensions.end());
  if (!written)
    for (const io::MotionFormat& format : io::motion_formats())
      if (std::find(out.begin(), out.end(), format.extension) == out.end()) out.push_back(format.extension);
  if (!written) out.emplace_back("json");
  return out;
}

/// "bunny.ply" as "bunny-bent.ply" in the same folder.
std::string beside(const std::string& path, const std::string& suffix, const std::string& extension) {
  const fs::path from(path);
  return (from.parent_path() / (from.stem().string() + suffix + extension)).string();
}

/// An edit, a motion or control points: no shape.
bool goes_on_top(const std::string& path) {
  return fs::path(path).extension() == ".json" || io::is_motion(path) || io::is_control_points(path);
}

}  // namespace

void Editor::answer(Request request) {
  switch (request) {
    case Request::Open: choose_file_to_open(); break;
    case Request::OpenRun: {
      const std::string run = pattern_of_run(session_.input_path());
      unless_unsaved(run, [this, run] { session_.open_shape(run); });
      break;
    }
    case Request::AddPoses: choose_poses(); break;
    case Request::AddControlPoints: choose_control_points(); break;
    case Request::SaveAs: choose_file_to_save(); break;
    case Request::Export: choose_file_to_export(); break;
    case Request::Screenshot: {
      const std::string path = beside(session_.input_path(), "", ".png");
      ask_for_file({.title = "Save a picture of the scene",
                    .action = "Save",
                    .save = true,
                    .extensions = {"png"},
                    .start = path,
                    .note = {},
                    .folder_action = {},
                    .folder_help = {},
                    .done = [this](const std::string& chosen) { save_screenshot(chosen); }});
      break;
    }
    case Request::Turntable: ui_.turntable = true; break;
    case Request::TurntableName: choose_name_of_turntable(); break;
    case Request::CopyCommand: copy_command(); break;
    case Request::Palette: ui_.palette = true; break;
    case Request::Keymap: ui_.keymap = true; break;
    case Request::About: ui_.about = true; break;
    case Request::Preferences: ui_.settings = true; break;
    case Request::NavigationChoice: ui_.navigation_choice = true; break;
    case Request::Column: ui_.column_open = !ui_.column_open; break;
    case Request::Quit: quit(); break;
  }
}

/// Shapes that were named together are a shape and its poses; anything else is opened by itself after them.
void Editor::open_later(std::vector<std::string> paths) {
  const auto others = std::stable_partition(paths.begin(), paths.end(), [](const auto& p) { return !goes_on_top(p); });
  if (others != paths.begin()) to_open_.emplace_back(paths.begin(), others);
  for (auto path = others; path != paths.end(); ++path) to_open_.push_back({*path});
}

void Editor::open_next() {
  if (session_.job() || !ui_.ask.text.empty()) return;
  if (const std::optional<std::string> shape = session_.take_declined())
    unless_unsaved(*shape, [this, path = *shape] { session_.open_shape(path); });
  if (to_open_.empty() || session_.job() || !ui_.ask.text.empty()) return;
  const std::vector<std::string> paths = to_open_.front();
  to_open_.pop_front();
  open(paths);
}

void Editor::open(const std::vector<std::string>& paths) {
  if (session_.joins(paths)) {
    view_.manipulation.reset();
    session_.open(paths);
  } else {
    unless_unsaved(paths.front(), [this, paths] { session_.open(paths); });
  }
  frames_wanted_ = 2;
}

void Editor::unless_unsaved(const std::string& path, std::function<void()> open) {
  const auto open_it = [this, open = std::move(open)] {
    view_.manipulation.reset();
    open();
  };
  if (session_.dirty())
    ui_.ask = {"The edit is not saved. Open " + fs::path(path).filename().string() + " without saving it?",
               "Open without saving", open_it};
  else
    open_it();
  frames_wanted_ = 2;
}

void Editor::choose_file_to_open() {
  std::string start = session_.input_path();
  if (start.empty() && !preferences_.recent.empty()) start = preferences_.recent.front();
  ask_for_file({.title = "Open",
                .action = "Open",
                .save = false,
                .extensions = extensions(false),
                .start = start.empty() ? "." : fs::absolute(start).parent_path().string(),
                .note = {},
                .folder_action = "Open this folder",
                .folder_help = "The shapes in it are poses: of the shape that is open, else of the first of them",
                .done = [this](const std::string& path) { open_later({path}); },
                .done_several = [this](const std::vector<std::string>& paths) { open_later(paths); }});
}

void Editor::choose_poses() {
  ask_for_file({.title = "Add poses",
                .action = "Add pose",
                .save = false,
                .extensions = extensions(false),
                .start = fs::path(session_.input_path()).parent_path().string(),
                .note = "Poses have the points and faces of the shape, moved.",
                .folder_action = "Add this folder",
                .folder_help = "All shapes in it are poses",
                .done = [this](const std::string& path) { session_.add_poses(path); }});
}

void Editor::choose_control_points() {
  ui_.files.open(
      {.title = "Control points",
       .action = "Take",
       .save = false,
       .extensions = {"csv", "txt"},
       .start = fs::path(session_.input_path()).parent_path().string(),
       .note = "A row each: x, y, z, tx, ty, tz (or id, tx, ty, tz); t is the target. A first row may name them.",
       .folder_action = {},
       .folder_help = {},
       .done = [this](const std::string& path) { session_.add_control_points(path); }});
}

void Editor::choose_file_to_save() {
  const std::string path =
      session_.edit_path().empty() ? beside(session_.input_path(), ".edit", ".json") : session_.edit_path();
  ask_for_file({.title = "Save the edit",
                .action = "Save",
                .save = true,
                .extensions = {"json"},
                .start = path,
                .note = "A small file with marks and motions; `sinew deform` bends the same shape by it.",
                .folder_action = {},
                .folder_help = {},
                .done = [this](const std::string& chosen) { session_.save_edit(chosen); }});
}

void Editor::choose_file_to_export() {
  ask_for_file({.title = "Export the bent shape",
                .action = "Export",
                .save = true,
                .extensions = extensions(true),
                .start = bent_name(session_.input_path(), session_.moves()),
                .note = "Positions and normals change; everything else is written as it was read.",
                .folder_action = {},
                .folder_help = {},
                .done = [this](const std::string& chosen) { session_.export_shape(chosen, true); },
                .changes = [input = session_.input(), sequence = session_.sequence(), frame = session_.frame()](
                               const std::string& path) { return export_notes(path, *input, *sequence, frame); }});
}

void Editor::save_screenshot(const std::string& path) {
  try {
    draw_screenshot(path);
    session_.notify(Severity::Info, "Saved " + fs::path(path).filename().string() + ".");
  } catch (const InputError& error) {
    session_.notify(Severity::Error, error.what());
  }
}

void Editor::draw_screenshot(const std::string& path) {
  gpu::finish(*device_, frame_);
  gpu::begin_frame(*device_, frame_);
  stage_.update(frame_, session_, view_);
  gpu::RendererHandle renderer = gpu::create_renderer(*device_, paths_, gpu::offscreen_format);
  const gpu::Offscreen offscreen = gpu::create_offscreen(*device_, swapchain_.extent);
  const gpu::Scene scene = stage_.scene(session_, view_, theme(), stage_.points());
  io::save_bytes(path, gpu::png_bytes(gpu::render_picture(*device_, *renderer, offscreen, scene)), true);
}

void Editor::quit() {
  if (!session_.dirty()) {
    quit_ = true;
    return;
  }
  ui_.ask = {"The edit is not saved. Close without saving it?", "Close without saving", [this] { quit_ = true; }};
  frames_wanted_ = 2;
}

}  // namespace sinew::editor
