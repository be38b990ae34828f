#pragma once
/// Session: the one object that the window shows: the input, what the user made of it (History of Project), the present
/// selection, and the newest answer of the solver. The window calls everything from its one thread, and poll() once a
/// frame; reading, writing and solving happen on threads of the session's own, whose results poll() takes in. No call
/// waits for them.
///
/// Coordinates are relative to the input's origin, which is the scene's. All functions that edit do nothing while no
/// input is open (input() == nullptr); a bad argument of the user's (an impossible setting) becomes a notice.
///
/// What is shown at rest is the canonical answer: the one that `sinew deform INPUT --edit SAVED` gives, to rounding.
/// After a drag the edit is solved once from rest. Where that ends elsewhere than the drag did (another minimum), the
/// drag's pose is stored as Layer::start and solved from there; the shape on the screen then stays where the user
/// brought it, and so does the saved file. The same holds after undo and redo.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/editor/background.h"
#include "apps/editor/figures.h"
#include "apps/editor/marks.h"
#include "apps/editor/point_set.h"
#include "apps/editor/repeatable.h"
#include "apps/editor/residuals.h"
#include "engine/document/history.h"
#include "engine/document/journal.h"
#include "engine/document/markers.h"
#include "engine/document/solver_thread.h"
#include "engine/geometry/bounds.h"

namespace sinew::editor {

enum class Severity { Hint, Info, Warning, Error };
struct Notice {
  Severity severity = Severity::Info;
  std::string text;          ///< a sentence
  std::string command = {};  ///< id of the command that it offers as a button; or empty
};

/// Long work, to show with its progress and a Cancel.
struct Job {
  std::string what;      ///< "Reading bunny.ply"
  double fraction = -1;  ///< 0..1; below 0: unknown
  double seconds = 0;    ///< so far
  bool can_cancel = false;
};

/// What poll() or an edit changed since the last poll(): what the window must hand to the device again.
struct Changed {
  bool input = false;           ///< another shape: all buffers
  bool frame = false;           ///< another frame of it: all buffers, but the view stays
  bool weights = false;         ///< skinning weights of shown()
  bool pose = false;            ///< poses of shown(), and with them bent_positions()
  bool marks = false;           ///< point_marks(): marks or selection
  bool project = false;         ///< layers, history, names: panels, title
  bool control_points = false;  ///< new handles from a file of such
  bool any() const { return input || frame || weights || pose || marks || project; }
};

struct HandleView {
  Vec3 target = Vec3::Zero();    ///< mean of where its points are to be
  Mat3 axes = Mat3::Identity();  ///< its own axes: turned as the handle was
  std::size_t points = 0;
};

/// An example of the chosen layer.
struct ExampleView {
  std::string name, path;        ///< of the pose, of its file
  std::optional<double> pinned;  ///< what the user set it to; nothing: the solver finds it
  std::optional<double> weight;  ///< that is shown; nothing while the examples are not read
};

/// "walk.0001.obj" as "walk.####.obj": the run that a numbered file may be one of; empty where it has no number.
std::string pattern_of_run(const std::string& path);

/// What is odd about a motion, to tell: a sentence each, and not too many.
std::vector<std::string> notes_of(const document::Markers& markers);

class Session {
 public:
  /// `methods` must outlive the session (sinew::methods()). `wake` is called from other threads when poll() has
  /// something to take.
  explicit Session(std::span<const Method> methods, std::function<void()> wake = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  Changed poll();

  // Files

  /// Opens a shape, or an EDIT.json together with its "inputs" (an edit without inputs is laid on the present shape),
  /// or a motion (io::is_motion), which becomes the markers of the chosen layer, or control points
  /// (io::is_control_points), which become handles of it: one step of history. What is open
  /// stays until the new one is there, and stays if it can't be read (a notice). Replaces a running open.
  ///
  /// A folder or several shapes are poses of what is open (of the first of them, where nothing is): examples of the
  /// chosen layer, of a new one where there is none; one step of history. So is one shape over a layer that takes
  /// examples where it corresponds (poses.h); where not, it waits in take_declined().
  void open(const std::string& path) { open(std::vector{path}); }
  void open(const std::vector<std::string>& paths);
  /// Whatever else it could be.
  void open_shape(const std::string& path);
  /// Poses and nothing else: what is none is a notice.
  void add_poses(const std::string& path);
  /// Whatever else it could be: each control point becomes a handle of the chosen layer, on the point of the shape that
  /// is nearest; its target is in the file, moved by as much as the point is beside the place.
  void add_control_points(const std::string& path);
  /// Whether what is open would stay with open(paths), or may.
  bool joins(const std::vector<std::string>& paths) const;
  /// A shape that open() found to be no pose of what is open; to be opened by open_shape() if the user wants that.
  std::optional<std::string> take_declined();
  /// Shows a shape that is already there, under a name.
  void adopt(std::shared_ptr<const Shape> shape, const std::string& path, document::Project project = {});
  void close();

  /// Writes the edit (with the input's path) as soon as the answer is settled. Empty path: where it was read or saved.
  void save_edit(const std::string& path = {});
  /// Writes the bent shape, as soon as the answer is settled. `force` replaces an existing file; without, it is a
  /// notice.
  void export_shape(const std::string& path, bool force = false);

  // Never losing work: a journal of every step

  /// From now on; in document::journal_folder().
  void keep_journal(const std::string& folder);
  /// Opens what a program that was killed had open, with its history; once that is in this program's journal, the old
  /// one is removed. Where the input can't be read, it stays.
  void recover(std::shared_ptr<document::OldJournal> journal);
  /// The user leaves: what waits to be saved is saved, and the journal is removed, or kept where that failed.
  void leave();
  const document::Journal* journal() const { return journal_.get(); }

  std::optional<Job> job() const;  ///< what runs now: reading, writing, or preparing a layer
  void cancel_job();

  bool has_input() const { return input_ != nullptr; }
  const std::shared_ptr<const Shape>& input() const { return input_; }
  const std::string& input_path() const { return input_path_; }
  const std::string& edit_path() const { return edit_path_; }     ///< empty: never saved
  bool dirty() const { return dirty_; }                           ///< differs from what is on the disk
  const std::vector<std::string>& lost() const { return lost_; }  ///< what the last export's format could not hold

  // Time: a still has one frame, or those of the motion that drives a layer

  std::span<const int> frames() const {
    return sequence_ ? std::span<const int>(sequence_->frames) : std::span<const int>();
  }
  bool moves() const { return frames().size() > 1; }
  const std::shared_ptr<const Sequence>& sequence() const { return sequence_; }
  /// Its points come and go: a layer has a path, and selections belong to a frame.
  bool stream() const { return stream_; }
  double rate() const { return sequence_ ? sequence_->rate : 24; }
  int frame() const { return frame_; }                ///< that is shown
  int wanted_frame() const { return wanted_frame_; }  ///< that is on its way
  /// The nearest frame that there is; an interactive answer first, the final one when nothing follows.
  void go_to_frame(int frame);
  void step_frame(int by);
  /// To the next or former key of the chosen layer.
  void step_key(int by);
  void play(bool on);
  bool playing() const { return playing_; }
  bool looping() const { return loop_; }
  void set_looping(bool on) { loop_ = on; }
  /// The frames that play() plays, first to last; all of them where none were chosen.
  std::pair<int, int> play_range() const;
  void set_play_range(std::optional<std::pair<int, int>> range) { range_ = range; }
  bool plays_all() const { return !range_.has_value(); }
  /// Seconds until poll() wants to be called again to play on; below 0: never.
  double next_step() const;

  /// Of the chosen layer; each is one step of history.
  void insert_key();  ///< at frame(), with the motions that its handles have there
  void delete_key(int frame);
  void move_key(int frame, int to);
  void set_interpolation(int frame, document::Interpolation interpolation);

  // Motion capture: markers of layers, by open()

  void set_markers(const document::MarkersEdit& edit);  ///< of the chosen layer, where it has some
  void remove_markers();
  /// Of the chosen layer's newest answer; null where there are none.
  const document::Markers* markers() const;
  /// Of all layers, where they are at frame(); coordinates relative to the input's origin.
  std::vector<document::Markers::Picture> marker_pictures() const;

  // Examples of the chosen layer

  std::vector<ExampleView> examples() const;
  /// Each is one step of history. A weight is asked for at the frame shown where the layer has keys or moves.
  void pin_example(std::size_t example, std::optional<double> weight);  ///< nothing lets it go
  void pin_examples();                                                  ///< all of them where they are
  void free_examples();
  void rest_examples();  ///< all pinned at 0
  void remove_example(std::size_t example);
  /// A drag of a weight: like one of a handle, ended by end_drag() or cancel_drag(). False where there is none yet.
  bool begin_weight(std::size_t example);
  void weight_to(double weight);

  // What is shown
  // ------------------------------------------------------------------------------------------------------

  /// Results of the layers that are on, lowest first: weights and pose of each. With one layer the device can bend the
  /// rest shape itself (set_weights, pose_points); with several, hand it bent_positions(). Empty: the rest shape.
  const std::vector<document::LayerResult>& shown() const { return shown_; }
  /// n positions, bent on the CPU when asked for and then kept until the pose changes.
  std::span<const Vec3> bent_positions();
  /// Changes with every change of bent_positions().
  std::uint64_t bent_version() const { return bent_version_; }
  /// Tickets of the newest request to the solver and of the drag's newest answer that is shown.
  std::uint64_t asked() const { return ticket_; }
  std::uint64_t shown_ticket() const { return shown_ticket_; }
  /// Bits of shared.h a point; n.
  const std::vector<std::uint8_t>& point_marks();
  /// How stiff the chosen layer makes the material around each point; n, or none where it says nothing.
  std::vector<float> point_stiffness();
  const Bounds& rest_bounds() const { return bounds_; }
  Bounds bent_bounds();
  Bounds selection_bounds();  ///< bent; of the chosen handle where nothing is selected; empty where neither is

  /// Solving, or a settling answer is still to come. While it is false after an edit, the canonical answer is shown.
  bool solving() const;
  const StatusFigures& figures() const { return figures_; }
  /// What the user should know now: "A handle needs something fixed ...". Computed from the state, not kept.
  std::vector<Notice> hints() const;
  /// Notices in the order they came; taken out by this call.
  std::vector<Notice> take_notices();
  void notify(Severity severity, std::string text);

  // Selection

  const PointSet& selection() const { return selection_; }
  /// `touched` of n points; points that are not finite are left out.
  void select(const PointSet& touched, SelectMode mode);
  void select_all();
  void select_none();
  void invert_selection();
  /// These need the neighbourhood, which is found in the background at the first of them (a job); done when it is
  /// there.
  void grow_selection();
  void shrink_selection();
  void select_connected();
  /// Hidden points are neither drawn, picked nor selected, and are bent all the same. No part of the project; other
  /// points (another shape, the next frame of a stream) are all shown.
  const PointSet& hidden() const { return hidden_; }
  void hide_selection();
  void hide_unselected();
  void show_hidden();
  /// The points of a handle, of the fixed, of all rigid groups, of what is stiffer or softer.
  void select_handle(std::size_t handle);
  void select_fixed();
  void select_rigid();
  void select_stiff();

  // Edits: each is one step of history
  // ---------------------------------------------------------------------------------

  const document::Project& project() const { return history_.present(); }
  const document::History& history() const { return history_; }
  std::span<const Method> methods() const { return methods_; }

  std::size_t chosen_layer() const { return layer_; }
  void choose_layer(std::size_t layer);
  /// Null where there is none.
  const document::Layer* layer() const;
  /// The chosen layer's, or the one that a first mark's layer will have; null where nobody knows it.
  const Method* method() const;

  void mark_selection(
      Mark mark);  ///< in the chosen layer (made where there is none); a new handle becomes the chosen one
  void delete_handle(std::size_t handle);
  void reset_handle(std::size_t handle);  ///< back to where its points rest

  /// A curtain in the chosen layer (made where there is none), at rest; world coordinates.
  void add_cut(std::span<const Vec3> path, const Vec3& depth);
  void remove_cut();                          ///< the last one
  void add_layer(const std::string& method);  ///< above all others; chosen
  void remove_layer(std::size_t layer);
  void move_layer(std::size_t layer, int by);  ///< up (1) or down (-1) in the stack; stays chosen
  void rename_layer(std::size_t layer, const std::string& name);
  void toggle_layer(std::size_t layer);
  void set_method(std::size_t layer, const std::string& method);
  /// A number or a choice; the standard value leaves the layer. Impossible ones become a notice.
  void set_setting(std::size_t layer, const std::string& name, const std::variant<double, std::string>& value);
  /// As it stands in the layer, or the standard.
  double setting(std::size_t layer, const Setting& setting) const;

  void undo();
  void redo();
  void go_to(std::size_t state);

  // Handles and drags

  /// Of the chosen layer, in the order of Layer::handles; while a drag runs, with the drag.
  std::vector<HandleView> handles();
  std::optional<std::size_t> chosen_handle() const { return handle_; }
  void choose_handle(std::optional<std::size_t> handle) { handle_ = handle; }

  /// Of the chosen layer's handles with points, the farthest first; while a drag runs, with the drag. Empty while the
  /// answer is on its way.
  const std::vector<Residual>& residuals();

  /// False where there is no such handle. Ends a drag that runs.
  bool begin_drag(std::size_t handle);
  /// The motion since begin_drag, not since the last call. Asks the solver for an interactive answer.
  void drag_to(const Transform& motion);
  /// One step of history (none where nothing moved); the final answer is asked for.
  void end_drag();
  void cancel_drag();
  bool dragging() const { return drag_.has_value(); }

 private:
  /// The end of a drag on its way to the canonical answer.
  struct Settling {
    enum class Step { FromRest, FromDrag } step = Step::FromRest;
    std::size_t layer = 0;                                  ///< that was dragged
    std::vector<document::LayerResult> dragged, from_rest;  ///< shown when the drag ended; the first answer
    document::Project project;                              ///< with the drag's pose as Layer::start
  };
  struct Drag {
    std::size_t handle = 0;
    std::optional<std::size_t> example;  ///< whose weight is dragged, in place of a handle
    std::string label = "Drag handle";
    document::Project now;
    document::Motion before;                   ///< the handle's, at the frame
    Vec3 centre = Vec3::Zero();                ///< mean of the handle's points where the layer starts
    std::uint64_t first_ticket = 0;            ///< of its requests
    std::vector<document::LayerResult> shown;  ///< before it began
    std::optional<Settling> settling;          ///< of the drag before, interrupted by this one
    bool moved = false, unsettled = false;
  };
  struct Opened;
  struct Control;
  /// What is to be opened next.
  struct Opening {
    enum class As { Either, Shape, Poses, FirstPoses, ControlPoints, Recovered } as = As::Either;
    std::vector<std::string> paths;
    std::shared_ptr<document::OldJournal> journal = nullptr;
  };
  /// What waits until the answer is settled.
  struct Waiting {
    enum class What { Save, Export } what = What::Save;
    std::string path;
    bool force = false;
  };

  void open_next(Opening opening);
  void open_first(const std::vector<std::string>& paths);
  std::optional<document::Layer> layer_to_pose();
  void open_poses(const Opening& opening);
  void take_poses(const std::vector<std::string>& files, std::size_t poses, bool first);
  std::vector<std::optional<double>> asked_weights() const;
  std::optional<std::vector<std::optional<double>>> known_weights() const;
  document::Layer with_weights(std::vector<std::optional<double>> weights) const;
  void set_weights(std::vector<std::optional<double>> weights, const std::string& label);
  Drag drag_from_here();
  std::optional<document::Layer> layer_to_drive(const std::string& path);
  void open_motion(const std::string& path);
  void open_control_points(const std::string& path);
  void take_control_points(const std::string& path, std::vector<Control> controls);
  void take_motion(const document::Markers& markers);
  void retime();
  bool preparing() const;
  void cancel_preparing();
  void show_frame(document::SolveAnswer answer);
  void advance();
  bool keyed() const;
  document::Layer keyed_here(bool of_weights = false) const;
  document::Motion motion_now(std::size_t handle) const;
  const document::LayerResult* shown_layer() const;
  void open_now(const Opening& opening);
  void read(const std::string& path);
  void read_journal(const std::shared_ptr<document::OldJournal>& journal);
  static void read_shape(Opened& opened, const Tell& tell);
  static void read_motion(Opened& opened);
  static void prepare(Opened& opened);
  void begin_journal(const Opened& opened);
  void watch_journal();
  void hash_input(const std::vector<std::string>& expected);
  void show(Opened opened);
  void apply(document::Project project, const std::string& label);
  void project_changed();
  void ask(SolveOptions::Quality quality, const document::Project& project);
  void take_answer(document::SolveAnswer answer);
  void show_answer(std::vector<document::LayerResult> layers);
  void settle(std::vector<document::LayerResult> layers);
  void measure();
  bool settled() const;
  void start_waiting();
  bool finish_waiting();
  void resume(Drag drag);
  void save_now(const Waiting& waiting);
  void export_now(const Waiting& waiting);
  void export_frames(const Waiting& waiting);
  void with_neighbourhood(std::function<void()> then);
  void take_background();
  const LayerPoints& layer_points();
  const std::vector<Vec3>& handle_rest_centres();
  document::Layer standard_layer() const;
  void selection_changed();
  PointSet selectable() const;
  void hide(const PointSet& points);
  void select_points(const std::vector<std::vector<Index>>& lists);
  document::Motion motion_of_new_handle();
  bool refuse(const std::function<void()>& check);

  std::vector<Method> methods_;       ///< repeatable, for the solver that is asked again and again
  std::vector<Method> file_methods_;  ///< as they are: exports begin as the command line does
  std::function<void()> wake_;

  std::shared_ptr<const Shape> input_;
  std::shared_ptr<const Sequence> source_;               ///< as the file has it
  std::shared_ptr<const Sequence> sequence_;             ///< all frames, a motion's included; input_ is one of them
  std::map<std::string, document::MotionTime> motions_;  ///< of motions that were read, by path
  std::string driven_by_;                                ///< the one that sequence_ follows; empty: none
  bool stream_ = false;
  int frame_ = 1, wanted_frame_ = 1;
  bool playing_ = false, loop_ = true;
  double play_began_ = 0;      ///< seconds, when play_from_ was shown
  std::size_t play_from_ = 0;  ///< index of a frame
  std::optional<std::pair<int, int>> range_;
  std::string input_path_, edit_path_;
  Bounds bounds_;
  document::History history_{document::Project{}};
  document::Project saved_;
  bool dirty_ = false;
  std::vector<std::string> lost_;
  std::size_t layer_ = 0;
  std::optional<std::size_t> handle_;
  PointSet selection_, finite_, hidden_;
  std::vector<Notice> notices_;
  Changed changed_;

  std::optional<Drag> drag_;
  std::optional<Settling> settling_;
  std::uint64_t ticket_ = 0;  ///< of the newest request
  std::uint64_t shown_ticket_ = 0;
  std::uint64_t final_ticket_ = 0;         ///< of the newest one that asked for Quality::Final
  std::optional<double> preparing_since_;  ///< seconds, when the solver was first seen to build what it builds
  bool answered_ = true;                   ///< the newest final request has its finished answer
  std::string failure_;  ///< why the newest request has no answer; empty: it has, or is on its way for the first time
  std::vector<document::LayerResult> shown_;
  std::vector<Vec3> bent_;
  bool bent_ready_ = false;
  std::uint64_t bent_version_ = 1, measured_version_ = 0;
  std::vector<std::uint8_t> marks_;
  bool marks_ready_ = false;
  StatusFigures figures_;

  std::shared_ptr<document::Selector> selector_;
  std::optional<LayerPoints> layer_points_;  ///< of the chosen layer of the present project
  std::optional<std::vector<Vec3>> handle_centres_;
  std::optional<std::vector<Residual>> residuals_;
  std::shared_ptr<const Neighbourhood> neighbourhood_;
  std::vector<std::function<void()>> after_neighbourhood_;
  std::optional<Opening> next_open_;
  std::optional<std::string> declined_;
  std::vector<Waiting> waiting_;
  std::unique_ptr<document::Journal> journal_;
  std::string input_hash_;  ///< input_hash.h; empty: not known yet, or there is none
  std::unique_ptr<Background> background_, measuring_, hashing_;
  std::unique_ptr<document::SolverThread> solver_;  ///< last: it goes first
};

}  // namespace sinew::editor
