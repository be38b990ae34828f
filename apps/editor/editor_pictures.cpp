#include <filesystem>

#include "apps/editor/command_line.h"
#include "apps/editor/editor.h"
#include "engine/geometry/error.h"
#include "engine/gpu/png.h"
#include "engine/io/frame_pattern.h"
#include "engine/io/io.h"

namespace sinew::editor {

namespace {

namespace fs = std::filesystem;

/// The start shows two rows of three.
constexpr std::size_t most_pictured = 6;

/// "bunny.ply" as "bunny-turn.####.png", "walk.####.obj" as "walk-turn.####.png".
std::string turntable_name(const std::string& input) {
  const fs::path path(input);
  std::string name = path.stem().string();
  name.resize(std::min(name.find_first_of("#@%"), name.size()));
  while (!name.empty() && (name.back() == '.' || name.back() == '_' || name.back() == '-')) name.pop_back();
  return (path.parent_path() / (name + "-turn.####.png")).string();
}

/// "turn.png" as "turn.####.png": a name without a place for the number gets one.
std::string with_place(const std::string& path) {
  if (fs::path(path).filename().string().find_first_of("#@%") != std::string::npos) return path;
  return (fs::path(path).parent_path() / (fs::path(path).stem().string() + ".####.png")).string();
}

}  // namespace

void Editor::choose_name_of_turntable() {
  ask_for_file({.title = "Save the turntable",
                .action = "Save",
                .save = true,
                .extensions = {"png"},
                .start = turntable_name(session_.input_path()),
                .note = "#### stands for the number of the picture.",
                .folder_action = {},
                .folder_help = {},
                .done = [this](const std::string& chosen) { save_turntable(chosen); }});
}

/// Pictures of the shape as it is now, from around the point that the view turns about, while the window goes on.
void Editor::save_turntable(const std::string& chosen) {
  if (drawing_.busy()) {
    session_.notify(Severity::Hint, "A turntable is being written: cancel it, or wait until it is done.");
    return;
  }
  stage_.update_colors(session_, view_);
  Portrait portrait = portrait_of(session_, view_, stage_.coloring(), theme().look);
  const TurntableChoice& choice = ui_.turntable_choice;
  portrait.width = choice.width;
  portrait.height = choice.height;
  portrait.point_size *= choice.height / std::max(1.0, view_.size.y());
  portrait.point_size = std::max(1.0, portrait.point_size * static_cast<double>(scale()));
  portrait.validation = validation_;
  gpu::Camera camera = view_.camera;
  camera.shift = {0, 0};
  const Bounds bounds = session_.bent_bounds();
  const double aspect = static_cast<double>(choice.width) / choice.height;
  const std::string path = with_place(chosen);
  const std::string failure = sentence_of_failure([&] {
    const std::optional<io::FramePattern> pattern = io::frame_pattern(path);
    if (!pattern) throw file_error(path, "a name with a place for the picture's number, such as turn.####.png", "none");
    int number = 0;
    for (const gpu::Camera& from :
         gpu::cameras_around(camera, view_.up, choice.pictures, choice.degrees, bounds, aspect, 0))
      portrait.pictures.emplace_back(from, pattern->path(++number));
  });
  if (!failure.empty()) {
    session_.notify(Severity::Error, failure);
    return;
  }
  turntable_ = fs::path(path).filename().string();
  drawing_.start("Drawing " + turntable_, true, [this, portrait](const Tell& tell) -> Background::Finish {
    draw_portrait(portrait, tell);
    return [this, count = portrait.pictures.size()] {
      session_.notify(Severity::Info, "Saved " + std::to_string(count) + " pictures as " + turntable_ + ".");
    };
  });
  frames_wanted_ = 2;
}

/// What the threads that draw and ask have found.
void Editor::take_pictures() {
  for (Background* work : {&drawing_, &picturing_, &portal_}) {
    std::optional<Background::Outcome> outcome = work->take();
    if (!outcome) continue;
    frames_wanted_ = 2;
    if (outcome->finish) outcome->finish();
    // The small picture of a recent file is no matter to bother anyone with.
    if (!outcome->error.empty() && work != &picturing_) session_.notify(Severity::Error, outcome->error);
    if (outcome->cancelled && work == &drawing_)
      session_.notify(Severity::Info, "The turntable was cancelled; what was drawn of it stays.");
  }
  if (drawing_.busy())
    ui_.drawing = Job{drawing_.what(), drawing_.fraction(), drawing_.seconds(), true};
  else
    ui_.drawing.reset();
  // Whoever leaves the dialog without a name wants no copy either.
  if (copy_when_saved_ && session_.dirty() && !ui_.files.shown() && !portal_.busy() && !session_.job() &&
      !session_.solving())
    copy_when_saved_ = false;
  if (copy_when_saved_ && !session_.dirty() && !session_.edit_path().empty()) copy_command();
  picture_recent();
}

/// Of the shape that was opened, once it is there and nothing else is to be done.
void Editor::picture_recent() {
  if (!wants_picture_ || !session_.has_input() || session_.job() || session_.solving() || picturing_.busy() ||
      session_.dragging())
    return;
  wants_picture_ = false;
  const std::string file = fs::absolute(session_.input_path()).lexically_normal().string();
  const std::string path = picture_path(file);
  if (path.empty() || stage_.points() == 0) return;
  Portrait portrait = portrait_of(session_, view_, stage_.coloring(), theme().look);
  portrait.width = recent_width;
  portrait.height = recent_height;
  portrait.ground = false;
  portrait.point_size = 1.5;
  portrait.validation = validation_;
  gpu::Camera camera;
  gpu::look_from(camera, "iso", view_.up);
  gpu::frame_bounds(camera, session_.bent_bounds(), static_cast<double>(recent_width) / recent_height, 0.88);
  portrait.pictures = {{camera, path}};
  picturing_.start("Picturing", true, [portrait, recent = preferences_.recent](const Tell& tell) -> Background::Finish {
    draw_portrait(portrait, tell);
    forget_pictures(recent);
    return [] {};
  });
}

/// The pictures of the recent files, into the texture of the fonts.
void Editor::show_recent_pictures() {
  std::vector<gpu::Picture> pictures;
  for (const std::string& file : preferences_.recent) {
    const std::string path = picture_path(file);
    std::error_code error;
    if (pictures.size() == most_pictured || path.empty() || !fs::is_regular_file(path, error)) continue;
    gpu::Picture picture;
    const std::string failure = sentence_of_failure([&] { picture = gpu::read_png(path); });
    if (!failure.empty() || picture.width > 2 * recent_width || picture.height > 2 * recent_height) continue;
    pictures.push_back(std::move(picture));
    ui_.pictured.push_back(file);
  }
  gui_->show_pictures(std::move(pictures));
}

/// The command needs the edit as a file: it is saved first where the user wants that.
void Editor::copy_command() {
  const bool asked_before = std::exchange(copy_when_saved_, false);
  if (session_.edit_path().empty() || session_.dirty()) {
    if (asked_before) return;
    const auto save = [this] {
      copy_when_saved_ = true;
      if (session_.edit_path().empty())
        choose_file_to_save();
      else
        session_.save_edit();
    };
    ui_.ask = {session_.edit_path().empty()
                   ? "The command line reads the edit from a file, and this one has none yet."
                   : "The edit has changed since it was saved; the command line would do what it was before.",
               "Save and copy", save};
    frames_wanted_ = 2;
    return;
  }
  const std::string line = command_line_of(session_, sinew_word());
  window_.set_clipboard(line);
  session_.notify(Severity::Info, "Copied: " + line);
  frames_wanted_ = 2;
}

}  // namespace sinew::editor
