#pragma once
/// CommandLine: the `sinew` command that does what the window shows: the same shape, bent by the same edit.

#include <string>

#include "apps/editor/session.h"

namespace sinew::editor {

/// `text` as one word of a POSIX shell: as it is where nothing in it is special, else in single quotes.
std::string shell_word(const std::string& text);

/// Where the command writes to: beside the input, "bunny.ply" as "bunny-bent.ply", "walk.####.obj" as
/// "walk-bent.####.obj", a set of scans to a folder "scans-bent/"; PC2 for a still that a motion drives.
std::string bent_name(const std::string& input, bool moves);

/// What to call the command line: "sinew" where a shell finds it in PATH, else the one beside this program, quoted.
std::string sinew_word();

/// "sinew deform '/scans/my scan.ply' --edit /scans/lift.json -o '/scans/my scan-bent.ply'". Paths are absolute. The
/// edit is the one on the disk: what differs from it is not in the command (Session::dirty). Empty while no input is
/// open or the edit has no file.
std::string command_line_of(const Session& session, const std::string& program);

}  // namespace sinew::editor
