#include "apps/editor/editor.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <filesystem>

#include "deformers/methods.h"
#include "engine/io/poses.h"
#include "shaders/shared.h"

namespace sinew::editor {

namespace {

/// Bounds of the wait for the shape of a mouse event before the picture is drawn without it, seconds.
constexpr double least_patience = 0.012, most_patience = 0.06;

gpu::DeviceOptions device_options(const Window& window, bool validation) {
  gpu::DeviceOptions options = window.device_options();
  options.validation = validation;
  return options;
}

float used_scale(const Preferences& preferences, const Window& window) {
  const double scale = preferences.scale > 0 ? preferences.scale : window.content_scale();
  return static_cast<float>(std::clamp(scale, 0.75, 4.0));
}

MarkCounts count_marks(Session& session) {
  MarkCounts out;
  for (const std::uint8_t bits : session.point_marks()) {
    out.fixed += (bits & gpu::shared::mark_fixed) != 0;
    out.rigid += (bits & gpu::shared::mark_rigid) != 0;
  }
  for (const float factor : session.point_stiffness()) {
    out.stiffer += factor > 1;
    out.softer += factor < 1;
  }
  return out;
}

bool same_camera(const gpu::Camera& a, const gpu::Camera& b) {
  return a.eye == b.eye && a.target == b.target && a.up == b.up && a.shift == b.shift && a.fov == b.fov &&
         a.orthographic == b.orthographic;
}

}  // namespace

Editor::Editor(const EditorOptions& options)
    : window_(options.window),
      device_(gpu::create_device(device_options(window_, options.validation))),
      paths_(gpu::measure_paths(*device_)),
      swapchain_(gpu::create_swapchain(*device_)),
      renderer_(gpu::create_renderer(*device_, paths_, swapchain_.format)),
      frame_(gpu::create_frame(*device_)),
      gui_(std::make_unique<Gui>(window_, *device_, swapchain_.cover, 3)),
      preferences_path_(preferences_path()),
      session_(methods(), Window::wake),
      context_{session_, view_, preferences_, [this](Request request) { answer(request); }},
      stage_(*device_, paths_, Window::wake),
      mouse_(context_),
      ui_{context_, stage_, mouse_},
      validation_(options.validation),
      drawing_(Window::wake),
      picturing_(Window::wake),
      portal_(Window::wake) {
  open_later(options.files);
  if (const std::string folder = document::journal_folder(); !folder.empty()) {
    session_.keep_journal(folder);
    ui_.recovery.look(folder);
  }
  LoadedPreferences loaded = load_preferences(preferences_path_);
  preferences_ = saved_preferences_ = loaded.preferences;
  if (!loaded.notice.empty()) session_.notify(Severity::Warning, loaded.notice);
  view_.up = preferences_.up;
  view_.point_size = preferences_.point_size;
  view_.brush_radius = preferences_.brush_radius;
  view_.depth = preferences_.through ? Depth::Through : Depth::VisibleOnly;
  ui_.device = paths_.sentence;
  ui_.sample = options.sample;
  ui_.cancel_drawing = [this] { drawing_.cancel(); };
  show_recent_pictures();
  ui_.navigation_choice = !preferences_.asked_navigation;
  if (!options.times.empty()) times_.open(options.times);
  last_step_ = now();
  use_preferences();
}

Editor::~Editor() {
  gpu::finish(*device_, frame_);
  gpu::wait_idle(*device_);
}

void Editor::run() {
  while (!quit_) {
    const bool busy = session_.job() || drawing_.busy() || !to_open_.empty() ||
                      (session_.solving() && !session_.dragging() && !session_.playing());
    window_.hold_play(busy);
    window_.wait(patience());
    take_events();
    take_changes();
    if (shape_moved_ == false && session_.dragging()) wait_for_shape();
    if (wants_frame()) draw();
    open_next();
    if (window_.played_all() && !busy) quit_ = true;
  }
  session_.leave();
}

void Editor::use_preferences() {
  gui_->use(preferences_.dark ? dark_theme() : light_theme(), used_scale(preferences_, window_));
  if (preferences_ == saved_preferences_) return;
  const std::string problem = save_preferences(preferences_path_, preferences_);
  if (!problem.empty()) session_.notify(Severity::Warning, problem);
  saved_preferences_ = preferences_;
}

void Editor::interface_frame(VkExtent2D size) {
  view_.size = {size.width, size.height};
  gui_->begin(size);
  ui_.layout = layout_of(ui_, static_cast<float>(size.width), static_cast<float>(size.height));
  // The target stands in the middle of what panels leave free.
  const Layout& layout = ui_.layout;
  view_.camera.shift = {static_cast<double>(layout.column / layout.width) - 1,
                        1 - static_cast<double>((layout.top + layout.bottom) / layout.height)};
}

void Editor::take_events() {
  std::deque<InputEvent>& events = window_.events();
  while (!events.empty()) {
    // One change of a button or key a frame of the interface, so that none is lost however slow the pictures are.
    std::vector<InputEvent> batch;
    bool change = false;
    while (!events.empty() && !change) {
      const InputEvent::What what = events.front().what;
      change = what == InputEvent::What::Button || what == InputEvent::What::Key;
      batch.push_back(std::move(events.front()));
      events.pop_front();
      gui_->feed(batch.back());
    }
    const VkExtent2D size = window_.size();
    if (size.width == 0 || size.height == 0) {
      for (const InputEvent& event : batch)
        if (event.what == InputEvent::What::Close) quit();
      continue;
    }
    interface_frame(size);
    for (const InputEvent& event : batch) deliver(event);
    const std::uint64_t before = session_.asked();
    show_ui(ui_);
    ImGui::EndFrame();
    if (session_.dragging() && session_.asked() != before) asked_.emplace_back(session_.asked(), batch.back().time);
    frames_wanted_ = 2;
  }
}

void Editor::deliver(const InputEvent& event) {
  const bool was_dragging = session_.dragging();
  const std::uint64_t before = session_.asked();
  switch (event.what) {
    case InputEvent::What::Close: quit(); return;
    case InputEvent::What::Drop: {
      std::vector<std::string> paths = event.paths;
      std::sort(paths.begin(), paths.end(), io::in_natural_order);
      open_later(std::move(paths));
      return;
    }
    case InputEvent::What::Key: press_key(event); break;
    default: break;
  }
  const bool over_ui = ImGui::GetIO().WantCaptureMouse && !mouse_.busy();
  mouse_.handle(event, over_ui);
  if (was_dragging && session_.dragging() && session_.asked() != before)
    asked_.emplace_back(session_.asked(), event.time);
}

void Editor::press_key(const InputEvent& event) {
  if (event.action == 0 || ImGui::GetIO().WantTextInput) return;
  if (ui_.dialog()) return;
  if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) {
    if (event.code == key::escape) ImGui::ClosePopupToLevel(0, false);
    return;
  }
  if (mouse_.press(event.code, event.modifiers)) return;
  if (const Command* command = command_for(event.code, event.modifiers, context_)) {
    run_command(*command, context_);
  } else if (const std::string why = why_no_command_for(event.code, event.modifiers, context_); !why.empty()) {
    session_.notify(Severity::Hint, why);
  }
}

void Editor::take_changes() {
  const double time = now(), step = time - last_step_;
  last_step_ = time;
  if (view_.glide.running()) {
    const Eigen::Vector2d shift = view_.camera.shift;
    view_.camera = view_.glide.advance(std::min(step, 0.05));
    view_.camera.shift = shift;
  }
  const Changed changed = session_.poll();
  stage_.note(changed);
  for (std::string& problem : ui_.recovery.poll()) session_.notify(Severity::Warning, std::move(problem));
  if (stage_.poll()) frames_wanted_ = 2;  // panels show what the first of them has taken in
  take_pictures();
  if (changed.marks || changed.input) ui_.marks = count_marks(session_);
  if (changed.input) show_new_input();
  if (changed.control_points) view_.show_residuals = true;
  if (changed.any()) frames_wanted_ = std::max(frames_wanted_, 1);
  shape_moved_ |= changed.pose || changed.input || changed.frame;
  use_preferences();
  const std::string name = std::filesystem::path(session_.input_path()).filename().string();
  window_.set_title(name.empty() ? "Sinew" : fmt::format("{}{} - Sinew", name, session_.dirty() ? " *" : ""));
}

void Editor::show_new_input() {
  view_.glide.stop();
  std::erase_if(ui_.toasts, [](const Toast& toast) { return now() - toast.since > 1; });  // of what was open before
  if (!session_.has_input()) return;
  ui_.layout = layout_of(ui_, static_cast<float>(view_.size.x()), static_cast<float>(view_.size.y()));
  view_.camera.shift = {static_cast<double>(ui_.layout.column / ui_.layout.width) - 1,
                        1 - static_cast<double>((ui_.layout.top + ui_.layout.bottom) / ui_.layout.height)};
  gpu::look_from(view_.camera, "iso", view_.up);
  view_.camera = framed(view_.camera, session_.rest_bounds(), view_.size.x() / view_.size.y());
  view_.ball_radius = 0.03 * session_.rest_bounds().diagonal();
  view_.choosing.reset();
  view_.color_by.clear();
  view_.heat.reset();
  view_.color_range.reset();
  view_.clicked.reset();
  for (const Attribute& attribute : session_.input()->attributes)
    if (attribute.kind == Kind::Color && view_.color_by.empty()) view_.color_by = attribute.name;
  add_recent(preferences_, std::filesystem::absolute(session_.input_path()).string());
  wants_picture_ = true;
}

/// A picture without the shape of the newest mouse event would hold up the one with it by as long as it takes to draw:
/// so long a wait is worth it.
void Editor::wait_for_shape() {
  const double end = now() + std::clamp(picture_seconds_, least_patience, most_patience);
  while (!asked_.empty() && session_.shown_ticket() < asked_.back().first && now() < end) {
    window_.wait(std::max(1e-4, end - now()));
    const Changed changed = session_.poll();
    stage_.note(changed);
    shape_moved_ |= changed.pose;
    if (changed.marks) ui_.marks = count_marks(session_);
    if (changed.any()) frames_wanted_ = std::max(frames_wanted_, 1);
  }
}

bool Editor::wants_frame() const {
  return frames_wanted_ > 0 || view_.glide.running() || !detail_.complete() || ui_.wants_frames || acquired_late_ ||
         now() >= ui_.next_frame;
}

double Editor::patience() const {
  if (quit_ || frames_wanted_ > 0 || view_.glide.running()) return 0;
  if (!to_open_.empty() && !session_.job()) return 0;
  if (acquired_late_ || !detail_.complete()) return 0.02;
  if (ui_.wants_frames) return 0.033;
  if (session_.next_step() >= 0) return session_.next_step();
  if (session_.job() || drawing_.busy()) return 0.1;
  return ui_.next_frame < 1e300 ? std::max(0.0, ui_.next_frame - now()) : -1;
}

void Editor::draw() {
  const VkExtent2D size = window_.size();
  gpu::begin_frame(*device_, frame_);
  acquired_late_ = false;
  if (size.width == 0 || size.height == 0) {
    frames_wanted_ = 0;
    return;
  }
  if (!gpu::acquire(*device_, swapchain_, size)) {
    acquired_late_ = true;
    return;
  }
  if (frames_wanted_ > 0) --frames_wanted_;
  ui_.wants_frames = false;
  ui_.next_frame = 1e300;
  interface_frame(swapchain_.extent);
  show_ui(ui_);
  if (ImGui::GetIO().WantTextInput) ui_.next_frame = std::min(ui_.next_frame, now() + 0.4);  // the caret blinks
  window_.set_cursor(Gui::cursor());
  ImGui::Render();
  const bool moving = shape_moved_ || !same_camera(view_.camera, drawn_camera_);
  drawn_camera_ = view_.camera;
  shape_moved_ = false;
  draw_scene(moving);
}

void Editor::draw_scene(bool moving) {
  const double begin = now();
  stage_.update(frame_, session_, view_);
  const std::size_t count = detail_.begin_frame(stage_.is_mesh() ? 0 : stage_.points(), moving, begin);
  const std::uint64_t ticket = session_.shown_ticket();
  Bounds bounds = session_.rest_bounds();
  if (session_.has_input())
    for (const HandleView& handle : session_.handles()) bounds.add(handle.target);
  for (const document::Markers::Picture& picture : session_.marker_pictures()) picture.add_to(bounds);
  gpu::Camera& camera = view_.camera;
  gpu::fit_depth(camera, bounds);
  const gpu::Scene scene = stage_.scene(session_, view_, theme(), count);
  VkCommandBuffer commands = gpu::begin_picture(*device_, *renderer_, frame_, scene, gpu::final_target(swapchain_));
  gui_->draw(commands);
  gpu::end_picture(*device_, frame_, commands);
  gpu::submit(*device_, frame_, gpu::acquired(swapchain_), gpu::drawn(swapchain_));
  gpu::present(*device_, swapchain_);
  gpu::finish(*device_, frame_);
  const double shown = now();
  picture_seconds_ = shown - begin;
  detail_.end_frame(picture_seconds_);
  while (!asked_.empty() && (asked_.front().first <= ticket || !session_.dragging())) {
    if (times_.is_open() && asked_.front().first <= ticket)
      times_ << fmt::format("{:.6f} {}", shown - asked_.front().second, count) << std::endl;
    asked_.pop_front();
  }
}

}  // namespace sinew::editor
