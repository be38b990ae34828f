#include "apps/editor/commands.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace sinew::editor {

namespace {

// What enables a command.
bool always(const Context&) {
  return true;
}
bool open(const Context& c) {
  return c.session.has_input();
}
bool selected(const Context& c) {
  return c.session.has_input() && !c.session.selection().empty();
}
bool chosen(const Context& c) {
  return c.session.chosen_handle().has_value() && !c.view.manipulation;
}
bool with_volume(const Context& c) {
  return c.view.choosing && c.view.choosing->volume() != nullptr;
}
bool movable(const Context& c) {
  return (c.session.chosen_handle() || with_volume(c)) && !c.view.manipulation;
}
bool turnable(const Context& c) {
  return chosen(c) && !with_volume(c);
}
bool hides(const Context& c) {
  return !c.session.hidden().empty();
}
bool moving(const Context& c) {
  return c.session.moves();
}
bool ranged(const Context& c) {
  return c.session.moves() && !c.session.plays_all();
}
bool keyed_here(const Context& c) {
  if (c.session.layer() == nullptr) return false;
  const auto& keys = c.session.layer()->keys;
  return std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return key.frame == c.session.frame(); });
}
bool in_run(const Context& c) {
  return c.session.has_input() && !c.session.moves() && !pattern_of_run(c.session.input_path()).empty();
}
bool has_cut(const Context& c) {
  return c.session.layer() != nullptr && !c.session.layer()->cuts.empty();
}
bool driven(const Context& c) {
  return c.session.layer() != nullptr && c.session.layer()->markers.has_value();
}
bool takes_poses(const Context& c) {
  return c.session.has_input() &&
         (c.session.layer() == nullptr || (c.session.method() != nullptr && c.session.method()->parts.examples));
}
bool posed(const Context& c) {
  return c.session.layer() != nullptr && !c.session.layer()->examples.empty();
}
bool layered(const Context& c) {
  return c.session.layer() != nullptr;
}
bool knows_rigid(const Context& c) {
  return c.session.method() != nullptr && c.session.method()->parts.rigid;
}
bool knows_stiffness(const Context& c) {
  return c.session.method() != nullptr && c.session.method()->parts.stiffness;
}
bool knows_cuts(const Context& c) {
  return c.session.method() == nullptr || c.session.method()->parts.cuts;
}
bool can_be_rigid(const Context& c) {
  return selected(c) && knows_rigid(c);
}
bool can_be_stiff(const Context& c) {
  return selected(c) && knows_stiffness(c);
}
std::string why_not_known(const Context& c, const char* what, bool Method::Parts::*part) {
  if (!c.session.has_input() || c.session.method() == nullptr || c.session.method()->parts.*part) return {};
  std::string names;
  for (const Method& method : c.session.methods())
    if (method.parts.*part) names += (names.empty() ? "" : " or ") + method.name;
  return std::string(what) + " for the method " + names + ": this layer's is " + c.session.method()->name + ".";
}
std::string why_not_rigid(const Context& c) {
  return why_not_known(c, "Rigid regions are", &Method::Parts::rigid);
}
std::string why_not_stiff(const Context& c) {
  return why_not_known(c, "Stiffness is", &Method::Parts::stiffness);
}
std::string why_not_posed(const Context& c) {
  return c.session.layer() == nullptr ? "" : why_not_known(c, "Poses are", &Method::Parts::examples);
}
std::string why_not_cut(const Context& c) {
  return why_not_known(c, "Cuts are", &Method::Parts::cuts);
}
bool solid_shown(const Context& c) {
  return layered(c) && c.session.method() != nullptr && c.session.method()->parts.solid && c.view.show_graph;
}
bool can_undo(const Context& c) {
  return c.session.history().can_undo();
}
bool can_redo(const Context& c) {
  return c.session.history().can_redo();
}
bool working(const Context& c) {
  const std::optional<Job> job = c.session.job();
  return job && job->can_cancel;
}
double aspect(const View& view) {
  return view.size.x() / view.size.y();
}

void frame_all(Context& c) {
  glide_to(c.view, framed(c.view.camera, c.session.bent_bounds(), aspect(c.view)));
}
void frame_selection(Context& c) {
  const Bounds bounds = c.session.selection_bounds();
  glide_to(c.view, framed(c.view.camera, bounds.empty() ? c.session.bent_bounds() : bounds, aspect(c.view), 0.5));
}
void save(Context& c) {
  if (c.session.edit_path().empty())
    c.request(Request::SaveAs);
  else
    c.session.save_edit();
}
/// Where the range would be empty, its other end is that of the clip.
void begin_range(Context& c) {
  const int end = c.session.play_range().second, here = c.session.wanted_frame();
  c.session.set_play_range(std::pair(here, here < end ? end : c.session.frames().back()));
}
void end_range(Context& c) {
  const int begin = c.session.play_range().first, here = c.session.wanted_frame();
  c.session.set_play_range(std::pair(begin < here ? begin : c.session.frames().front(), here));
}
void look(Context& c, const char* name) {
  glide_to(c.view, viewed(c.view.camera, name, c.view.up));
}
void turn(Context& c, double x, double y) {
  gpu::Camera camera = c.view.camera;
  orbit(camera, {x * c.view.size.x() / 24, y * c.view.size.y() / 12}, c.view.size, c.view.up);  // 15 degrees
  glide_to(c.view, camera);
}
void set_up(Context& c, gpu::UpAxis up) {
  c.view.up = c.preferences.up = up;
  glide_to(c.view, levelled(c.view.camera, up));
}
void set_brush(Context& c, double factor) {
  const double diagonal = std::max(c.session.rest_bounds().diagonal(), 1e-300);
  if (c.view.tool == Tool::Ball)
    c.view.ball_radius = std::clamp(c.view.ball_radius * factor, 1e-4 * diagonal, diagonal);
  else
    c.view.brush_radius = c.preferences.brush_radius = std::clamp(c.view.brush_radius * factor, 2.0, 500.0);
}
void set_points(Context& c, double by) {
  c.view.point_size = c.preferences.point_size = std::clamp(c.view.point_size + by, 1.0, 16.0);
}
void toggle_depth(Context& c) {
  c.view.depth = c.view.depth == Depth::Through ? Depth::VisibleOnly : Depth::Through;
  c.preferences.through = c.view.depth == Depth::Through;
}
void choose_attribute(Context& c) {
  if (!c.view.color_by.empty())
    for (const std::string& name : range_choices(*c.session.input()))
      if (name == c.view.color_by) return choose_by_attribute(c.session, c.view, name);
  choose_by_attribute(c.session, c.view, c.view.up == gpu::UpAxis::Y ? "y" : "z");
}
void delete_something(Context& c) {
  if (c.session.chosen_handle()) c.session.delete_handle(*c.session.chosen_handle());
}

template <Tool tool>
void take_tool(Context& c) {
  confirm_choosing(c.view);
  c.view.tool = tool;
  if (tool == Tool::Volume && !c.session.selection().empty()) choose_by_volume(c.session, c.view);
}
template <Tool tool>
bool has_tool(const Context& c) {
  return c.view.tool == tool;
}

/// Colours by what the edit does, or by it no longer.
template <document::FieldKind kind>
void show_heat(Context& c) {
  const bool shown = c.view.heat == kind;
  c.view.color_range.reset();
  c.view.heat.reset();
  if (!shown) c.view.heat = kind;
}
template <document::FieldKind kind>
bool shows_heat(const Context& c) {
  return c.view.heat == kind;
}

using C = Context;
using document::FieldKind;
const std::array table{
    Command{"file.open", "Open...", "File", "Ctrl+O",
            "Open a shape, an edit, a folder of poses, or a motion for a solid.", always,
            [](C& c) { c.request(Request::Open); }},
    Command{"file.open_run", "Open all frames", "File", "", "Open all numbered files that this one is one of.", in_run,
            [](C& c) { c.request(Request::OpenRun); }},
    Command{"file.save", "Save edit", "File", "Ctrl+S", "Write the edit to its file.", open, save, nullptr, true},
    Command{"file.save_as", "Save edit as...", "File", "Ctrl+Shift+S", "Write the edit to another file.", open,
            [](C& c) { c.request(Request::SaveAs); }},
    Command{"file.export", "Export shape...", "File", "Ctrl+E", "Write the bent shape to a file.", open,
            [](C& c) { c.request(Request::Export); }},
    Command{"file.screenshot", "Save picture...", "File", "",
            "Write a picture of the scene (screenshot) to a PNG file.", open,
            [](C& c) { c.request(Request::Screenshot); }},
    Command{"file.turntable", "Save turntable...", "File", "", "Write pictures from all around as numbered PNG files.",
            open, [](C& c) { c.request(Request::Turntable); }},
    Command{"file.cancel", "Cancel work", "File", "", "Stop reading, writing or preparing a layer.", working,
            [](C& c) { c.session.cancel_job(); }, nullptr, true},
    Command{"file.preferences", "Preferences...", "File", "Ctrl+,", "Choose navigation, theme and scale.", always,
            [](C& c) { c.request(Request::Preferences); }, nullptr, true},
    Command{"file.quit", "Quit", "File", "Ctrl+Q", "Leave the program.", always, [](C& c) { c.request(Request::Quit); },
            nullptr, true},

    Command{"edit.undo", "Undo", "Edit", "Ctrl+Z", "Take back the last step.", can_undo,
            [](C& c) { c.session.undo(); }},
    Command{"edit.redo", "Redo", "Edit", "Ctrl+Shift+Z, Ctrl+Y", "Do again what was taken back.", can_redo,
            [](C& c) { c.session.redo(); }},
    Command{"edit.copy_command", "Copy as command line", "Edit", "Ctrl+Shift+C",
            "Put the sinew command that does the same on the clipboard.", layered,
            [](C& c) { c.request(Request::CopyCommand); }, nullptr, true},
    Command{"edit.palette", "Find a command...", "Edit", "Ctrl+P", "Search all commands by name.", always,
            [](C& c) { c.request(Request::Palette); }, nullptr, true},

    Command{"select.all", "All", "Select", "Ctrl+A", "Select all points.", open, [](C& c) { c.session.select_all(); }},
    Command{"select.none", "None", "Select", "Alt+A, Esc", "Select nothing.", selected,
            [](C& c) { c.session.select_none(); }},
    Command{"select.invert", "Invert", "Select", "Ctrl+I", "Select what is not selected.", open,
            [](C& c) { c.session.invert_selection(); }},
    Command{"select.grow", "Grow", "Select", "Ctrl+Num +, Ctrl+=", "Add the neighbours of the selected points.",
            selected, [](C& c) { c.session.grow_selection(); }, nullptr, true},
    Command{"select.shrink", "Shrink", "Select", "Ctrl+Num -, Ctrl+-", "Leave out the selection's border.", selected,
            [](C& c) { c.session.shrink_selection(); }},
    Command{"select.connected", "Connected", "Select", "L", "Select all that hangs together with the selection.",
            selected, [](C& c) { c.session.select_connected(); }},
    Command{"select.attribute", "By attribute...", "Select", "", "Select a range of an attribute, by its histogram.",
            open, choose_attribute},
    Command{"select.hide", "Hide", "Select", "Ctrl+H", "Neither draw, pick nor select the selected points.", selected,
            [](C& c) { c.session.hide_selection(); }, nullptr, true},
    Command{"select.hide_others", "Hide others", "Select", "Shift+H", "Show the selected points alone (isolate).",
            selected, [](C& c) { c.session.hide_unselected(); }},
    Command{"select.show", "Show all", "Select", "Alt+H", "Show what was hidden.", hides,
            [](C& c) { c.session.show_hidden(); }},
    Command{"select.handle", "Points of the handle", "Select", "", "Select the points of the chosen handle.", chosen,
            [](C& c) { c.session.select_handle(*c.session.chosen_handle()); }, nullptr, true},
    Command{"select.fixed", "Fixed points", "Select", "", "Select the points that stay.", layered,
            [](C& c) { c.session.select_fixed(); }},
    Command{"select.rigid", "Rigid points", "Select", "", "Select the points of all rigid regions.", layered,
            [](C& c) { c.session.select_rigid(); }},
    Command{"select.stiff", "Stiffer and softer points", "Select", "", "Select where the stiffness is changed.",
            layered, [](C& c) { c.session.select_stiff(); }},
    Command{"select.through", "Through", "Select", "Alt+Z", "Select what stands behind, too.", always, toggle_depth,
            [](const C& c) { return c.view.depth == Depth::Through; }, true},

    Command{"tool.select", "Select", "Edit/Tool", "V", "Click points and handles.", always, take_tool<Tool::Select>,
            has_tool<Tool::Select>},
    Command{"tool.move", "Move", "Edit/Tool", "", "Move the chosen handle by its arrows.", always,
            take_tool<Tool::Move>, has_tool<Tool::Move>},
    Command{"tool.rotate", "Rotate", "Edit/Tool", "", "Turn the chosen handle by its rings.", always,
            take_tool<Tool::Rotate>, has_tool<Tool::Rotate>},
    Command{"tool.scale", "Scale", "Edit/Tool", "", "Scale the chosen handle along its axes, or evenly.", always,
            take_tool<Tool::Scale>, has_tool<Tool::Scale>},
    Command{"tool.box", "Box", "Edit/Tool", "B", "Select in a box.", always, take_tool<Tool::Box>, has_tool<Tool::Box>,
            true},
    Command{"tool.lasso", "Lasso", "Edit/Tool", "Q", "Select in a drawn outline.", always, take_tool<Tool::Lasso>,
            has_tool<Tool::Lasso>},
    Command{"tool.polygon", "Polygon", "Edit/Tool", "P", "Select between corners that are clicked.", always,
            take_tool<Tool::Polygon>, has_tool<Tool::Polygon>},
    Command{"tool.brush", "Brush", "Edit/Tool", "C", "Paint the selection.", always, take_tool<Tool::Brush>,
            has_tool<Tool::Brush>},
    Command{"tool.ball", "Sphere brush", "Edit/Tool", "O", "Select in a sphere around the surface under the mouse.",
            always, take_tool<Tool::Ball>, has_tool<Tool::Ball>},
    Command{"tool.volume", "Box or sphere in space", "Edit/Tool", "Shift+O",
            "Select in a box or sphere that is moved and sized.", open, take_tool<Tool::Volume>,
            has_tool<Tool::Volume>},
    Command{"tool.cut", "Cut", "Edit/Tool", "Shift+C", "Draw a line that no influence of the chosen layer passes.",
            knows_cuts, take_tool<Tool::Cut>, has_tool<Tool::Cut>, false, why_not_cut},
    Command{"tool.smaller", "Smaller brush", "Edit/Tool", "[", "Paint with a smaller brush.", always,
            [](C& c) { set_brush(c, 1 / 1.15); }, nullptr, true},
    Command{"tool.larger", "Larger brush", "Edit/Tool", "]", "Paint with a larger brush.", always,
            [](C& c) { set_brush(c, 1.15); }},

    Command{"mark.handle", "Make a handle", "Layer", "H", "The selected points follow the mouse together.", selected,
            [](C& c) { c.session.mark_selection(Mark::Handle); }},
    Command{"mark.fixed", "Fix", "Layer", "K", "The selected points stay where they are.", selected,
            [](C& c) { c.session.mark_selection(Mark::Fixed); }},
    Command{"mark.rigid", "Make rigid", "Layer", "J", "The selected points turn as one.", can_be_rigid,
            [](C& c) { c.session.mark_selection(Mark::Rigid); }, nullptr, false, why_not_rigid},
    Command{"mark.stiffer", "Stiffer", "Layer", "T", "The material at the selected points is twice as stiff.",
            can_be_stiff, [](C& c) { c.session.mark_selection(Mark::Stiffer); }, nullptr, false, why_not_stiff},
    Command{"mark.softer", "Softer", "Layer", "Shift+T", "The material at the selected points is half as stiff.",
            can_be_stiff, [](C& c) { c.session.mark_selection(Mark::Softer); }, nullptr, false, why_not_stiff},
    Command{"mark.free", "Free", "Layer", "U", "The selected points are not marked in any way.", selected,
            [](C& c) { c.session.mark_selection(Mark::Free); }},
    Command{"handle.move", "Move handle", "Layer", "G", "Move the chosen handle; X, Y, Z and numbers hold it.", movable,
            [](C& c) { begin_manipulation(c.session, c.view, GizmoKind::Translate, GizmoPart::Screen, true); }, nullptr,
            true},
    Command{"handle.rotate", "Rotate handle", "Layer", "R", "Turn the chosen handle; X, Y, Z and numbers hold it.",
            turnable, [](C& c) { begin_manipulation(c.session, c.view, GizmoKind::Rotate, GizmoPart::Screen, true); }},
    Command{"handle.scale", "Scale handle", "Layer", "S", "Scale the chosen handle; X, Y, Z and numbers hold it.",
            movable, [](C& c) { begin_manipulation(c.session, c.view, GizmoKind::Scale, GizmoPart::Screen, true); }},
    Command{"handle.reset", "Reset handle", "Layer", "Alt+G", "Back to where the handle rests.", chosen,
            [](C& c) { c.session.reset_handle(*c.session.chosen_handle()); }},
    Command{"handle.delete", "Delete handle", "Layer", "Delete, Backspace", "The handle's points are free again.",
            chosen, delete_something},
    Command{"handle.from_file", "Control points from file...", "Layer", "",
            "Make a handle of each row of a CSV: a place or point of the shape, and its target.", open,
            [](C& c) { c.request(Request::AddControlPoints); }},
    Command{"handle.residuals", "Residuals", "Layer", "", "List how far each handle is from its target.", open,
            [](C& c) { c.view.show_residuals = !c.view.show_residuals; },
            [](const C& c) { return c.view.show_residuals; }},
    Command{"layer.add", "Add layer", "Layer", "", "Another edit on top of the present shape.", open,
            [](C& c) { c.session.add_layer(c.session.methods().front().name); }, nullptr, true},
    Command{"layer.toggle", "Show layer", "Layer", "", "Switch the chosen layer on or off.", layered,
            [](C& c) { c.session.toggle_layer(c.session.chosen_layer()); },
            [](const C& c) { return layered(c) && c.session.layer()->on; }},
    Command{"layer.remove_cut", "Remove last cut", "Layer", "", "Let influence pass again where it was cut last.",
            has_cut, [](C& c) { c.session.remove_cut(); }},
    Command{"layer.remove_motion", "Remove motion", "Layer", "", "Let no markers drive the chosen layer any more.",
            driven, [](C& c) { c.session.remove_markers(); }},
    Command{"layer.add_poses", "Add poses...", "Layer", "", "Blend the chosen layer from other poses of the shape.",
            takes_poses, [](C& c) { c.request(Request::AddPoses); }, nullptr, true, why_not_posed},
    Command{"layer.pin_weights", "Pin all weights", "Layer", "", "Hold the weights of all examples where they are.",
            posed, [](C& c) { c.session.pin_examples(); }},
    Command{"layer.free_weights", "Free all weights", "Layer", "", "Let the handles find the weights of all examples.",
            posed, [](C& c) { c.session.free_examples(); }},
    Command{"layer.rest_weights", "Weights at rest", "Layer", "", "Hold the weights of all examples at 0.", posed,
            [](C& c) { c.session.rest_examples(); }},
    Command{"layer.raise", "Raise layer", "Layer", "", "Let the chosen layer work after the one above it.", layered,
            [](C& c) { c.session.move_layer(c.session.chosen_layer(), 1); }, nullptr, true},
    Command{"layer.lower", "Lower layer", "Layer", "", "Let the chosen layer work before the one below it.", layered,
            [](C& c) { c.session.move_layer(c.session.chosen_layer(), -1); }},
    Command{"layer.remove", "Remove layer", "Layer", "", "Remove the chosen layer.", layered,
            [](C& c) { c.session.remove_layer(c.session.chosen_layer()); }},

    Command{"time.play", "Play", "Time", "Space", "Play the frames with the edit.", moving,
            [](C& c) { c.session.play(!c.session.playing()); }, [](const C& c) { return c.session.playing(); }},
    Command{"time.loop", "Loop", "Time", "", "Begin again at the end.", moving,
            [](C& c) { c.session.set_looping(!c.session.looping()); }, [](const C& c) { return c.session.looping(); }},
    Command{"time.range_begin", "Play from here", "Time", "Alt+[", "Begin to play at the frame shown.", moving,
            begin_range},
    Command{"time.range_end", "Play up to here", "Time", "Alt+]", "Play no farther than the frame shown.", moving,
            end_range},
    Command{"time.range_all", "Play all frames", "Time", "", "Play from the first frame to the last.", ranged,
            [](C& c) { c.session.set_play_range({}); }},
    Command{"time.onion", "Onion skin", "Time", "", "Show ghosts of frames before and after, while nothing moves.",
            moving, [](C& c) { c.view.show_onion = !c.view.show_onion; }, [](const C& c) { return c.view.show_onion; }},
    Command{"time.forward", "Next frame", "Time", "Right", "One frame on.", moving,
            [](C& c) { c.session.step_frame(1); }, nullptr, true},
    Command{"time.back", "Former frame", "Time", "Left", "One frame back.", moving,
            [](C& c) { c.session.step_frame(-1); }},
    Command{"time.first", "First frame", "Time", "Shift+Left", "To the beginning.", moving,
            [](C& c) { c.session.go_to_frame(c.session.frames().front()); }},
    Command{"time.last", "Last frame", "Time", "Shift+Right", "To the end.", moving,
            [](C& c) { c.session.go_to_frame(c.session.frames().back()); }},
    Command{"time.next_key", "Next key", "Time", "Up", "To the next key of the chosen layer.", moving,
            [](C& c) { c.session.step_key(1); }, nullptr, true},
    Command{"time.former_key", "Former key", "Time", "Down", "To the key before.", moving,
            [](C& c) { c.session.step_key(-1); }},
    Command{"time.key", "Set key", "Time", "I", "Hold where the handles are at this frame (keyframe).", moving,
            [](C& c) { c.session.insert_key(); }},
    Command{"time.delete_key", "Delete key", "Time", "Alt+I", "Forget the key at this frame.", keyed_here,
            [](C& c) { c.session.delete_key(c.session.frame()); }},

    Command{"view.frame_all", "Frame all", "View", "Home", "See all of the shape.", open, frame_all},
    Command{"view.frame", "Frame selection", "View", "F, Num .", "See the selected points, or the chosen handle.", open,
            frame_selection},
    Command{"view.front", "Front", "View/Direction", "Num 1", "Look from the front.", always,
            [](C& c) { look(c, "front"); }},
    Command{"view.back", "Back", "View/Direction", "Ctrl+Num 1", "Look from behind.", always,
            [](C& c) { look(c, "back"); }},
    Command{"view.right", "Right", "View/Direction", "Num 3", "Look from the right.", always,
            [](C& c) { look(c, "right"); }},
    Command{"view.left", "Left", "View/Direction", "Ctrl+Num 3", "Look from the left.", always,
            [](C& c) { look(c, "left"); }},
    Command{"view.top", "Top", "View/Direction", "Num 7", "Look from above.", always, [](C& c) { look(c, "top"); }},
    Command{"view.bottom", "Bottom", "View/Direction", "Ctrl+Num 7", "Look from below.", always,
            [](C& c) { look(c, "bottom"); }},
    Command{"view.iso", "Askew", "View/Direction", "", "Look from the front, right and above.", always,
            [](C& c) { look(c, "iso"); }},
    Command{"view.turn_left", "Turn left", "View/Direction", "Num 4", "Turn the view by 15 degrees.", always,
            [](C& c) { turn(c, 1, 0); }, nullptr, true},
    Command{"view.turn_right", "Turn right", "View/Direction", "Num 6", "Turn the view by 15 degrees.", always,
            [](C& c) { turn(c, -1, 0); }},
    Command{"view.turn_up", "Turn up", "View/Direction", "Num 8", "Turn the view by 15 degrees.", always,
            [](C& c) { turn(c, 0, 1); }},
    Command{"view.turn_down", "Turn down", "View/Direction", "Num 2", "Turn the view by 15 degrees.", always,
            [](C& c) { turn(c, 0, -1); }},
    Command{"view.orthographic", "Orthographic", "View", "Num 5", "Without perspective.", always,
            [](C& c) { c.view.camera.orthographic = !c.view.camera.orthographic; },
            [](const C& c) { return c.view.camera.orthographic; }, true},
    Command{"view.y_up", "Y is up", "View", "", "Turn the view so that Y is up; files are never turned.", always,
            [](C& c) { set_up(c, gpu::UpAxis::Y); }, [](const C& c) { return c.view.up == gpu::UpAxis::Y; }},
    Command{"view.z_up", "Z is up", "View", "", "Turn the view so that Z is up; files are never turned.", always,
            [](C& c) { set_up(c, gpu::UpAxis::Z); }, [](const C& c) { return c.view.up == gpu::UpAxis::Z; }},
    Command{"view.local", "Local axes", "View", "", "The chosen handle's own axes in place of the world's.", always,
            [](C& c) { c.view.space = c.view.space == Space::Local ? Space::World : Space::Local; },
            [](const C& c) { return c.view.space == Space::Local; }, true},
    Command{"view.history", "History", "View", "Ctrl+Shift+H", "List all steps; a click on one goes there.", open,
            [](C& c) { c.view.show_history = !c.view.show_history; }, [](const C& c) { return c.view.show_history; },
            true},
    Command{"view.graph", "Structure", "View", "", "Show the structure of the chosen layer.", always,
            [](C& c) { c.view.show_graph = !c.view.show_graph; }, [](const C& c) { return c.view.show_graph; }},
    Command{"view.cut_tets", "Cut tets open", "View", "", "Show the inside of the structure of a solid.", solid_shown,
            [](C& c) { c.view.cut_tets = !c.view.cut_tets; }, [](const C& c) { return c.view.cut_tets; }},
    Command{"view.markers", "Markers", "View", "", "Show the markers and bones of a motion.", always,
            [](C& c) { c.view.show_markers = !c.view.show_markers; }, [](const C& c) { return c.view.show_markers; }},
    Command{"view.displacement", "Colour by displacement", "View/Colour by", "", "How far each point was moved.",
            layered, show_heat<FieldKind::Displacement>, shows_heat<FieldKind::Displacement>},
    Command{"view.stretch", "Colour by stretch", "View/Colour by", "", "How much longer or shorter the shape is there.",
            layered, show_heat<FieldKind::Stretch>, shows_heat<FieldKind::Stretch>},
    Command{"view.rotation", "Colour by rotation", "View/Colour by", "", "How far the shape is turned there.", layered,
            show_heat<FieldKind::Rotation>, shows_heat<FieldKind::Rotation>},
    Command{"view.energy", "Colour by energy", "View/Colour by", "", "Where the structure of the layer is strained.",
            layered, show_heat<FieldKind::Energy>, shows_heat<FieldKind::Energy>},
    Command{"view.influence", "Colour by influence", "View/Colour by", "",
            "What follows the clicked point, or the chosen handle.", layered, show_heat<FieldKind::Influence>,
            shows_heat<FieldKind::Influence>},
    Command{"view.rest", "Rest shape", "View", "", "Show a ghost of the shape at rest.", always,
            [](C& c) { c.view.show_rest = !c.view.show_rest; }, [](const C& c) { return c.view.show_rest; }},
    Command{"view.ground", "Ground", "View", "", "Show the ground grid.", always,
            [](C& c) { c.view.show_ground = !c.view.show_ground; }, [](const C& c) { return c.view.show_ground; }},
    Command{"view.column", "Side column", "View", "N", "Show the column with scene, layers and settings.", open,
            [](C& c) { c.request(Request::Column); }},
    Command{"view.larger_points", "Larger points", "View", "Ctrl+]", "Draw points larger.", always,
            [](C& c) { set_points(c, 0.5); }, nullptr, true},
    Command{"view.smaller_points", "Smaller points", "View", "Ctrl+[", "Draw points smaller.", always,
            [](C& c) { set_points(c, -0.5); }},
    Command{"view.theme", "Light theme", "View", "", "A light window in place of a dark one.", always,
            [](C& c) { c.preferences.dark = !c.preferences.dark; }, [](const C& c) { return !c.preferences.dark; },
            true},

    Command{"help.keys", "Keys and mouse", "Help", "?, F1", "Show what keys and mouse buttons do.", always,
            [](C& c) { c.request(Request::Keymap); }},
    Command{"help.navigation", "Choose navigation...", "Help", "", "Navigate as in Blender, Maya or a scan viewer.",
            always, [](C& c) { c.request(Request::NavigationChoice); }},
    Command{"help.about", "About Sinew", "Help", "", "Version and licences.", always,
            [](C& c) { c.request(Request::About); }, nullptr, true},
};

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// How well a word is found: 0 not at all; in the title it counts more than in menu or help, at a word's start most.
int score_of(const Command& command, const std::string& word) {
  const std::string title = lower(command.title);
  const std::size_t at = title.find(word);
  if (at != std::string::npos) return at == 0 ? 4 : title[at - 1] == ' ' ? 3 : 2;
  return lower(std::string(command.menu) + " " + command.help).find(word) != std::string::npos ? 1 : 0;
}

}  // namespace

std::span<const Command> commands() {
  return table;
}

const Command* find_command(std::string_view id) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Command& c) { return id == c.id; });
  return found == table.end() ? nullptr : &*found;
}

std::vector<Chord> shortcuts_of(const Command& command) {
  std::vector<Chord> out;
  std::string_view text = command.shortcut;
  while (!text.empty()) {
    const std::size_t end = text.find(", ", 1);  // "Ctrl+," has a comma of its own
    const std::optional<Chord> chord = chord_of(text.substr(0, end));
    CHECK(chord.has_value(), command.id, command.shortcut);
    out.push_back(*chord);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 2);
  }
  return out;
}

const Command* command_for(int key, int modifiers, const Context& context) {
  for (const Command& command : table)
    for (const Chord& chord : shortcuts_of(command))
      if (matches(chord, key, modifiers) && command.enabled(context)) return &command;
  return nullptr;
}

std::string why_no_command_for(int key, int modifiers, const Context& context) {
  for (const Command& command : table)
    if (command.why_not != nullptr && !command.enabled(context))
      for (const Chord& chord : shortcuts_of(command))
        if (matches(chord, key, modifiers)) return command.why_not(context);
  return {};
}

bool run_command(const Command& command, Context& context) {
  if (!command.enabled(context)) return false;
  command.run(context);
  return true;
}

std::vector<const Command*> search_commands(std::string_view text) {
  std::vector<std::pair<int, const Command*>> found;
  for (const Command& command : table) {
    int total = 0;
    bool all = true;
    std::string rest = lower(text);
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      const std::string word = rest.substr(0, end);
      rest.erase(0, std::min(end + 1, rest.size()));
      if (word.empty()) continue;
      const int score = score_of(command, word);
      all = all && score > 0;
      total += score;
    }
    if (all) found.emplace_back(total, &command);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<const Command*> out;
  for (const auto& [score, command] : found) out.push_back(command);
  return out;
}

}  // namespace sinew::editor
