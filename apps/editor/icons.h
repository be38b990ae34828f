#pragma once
/// Icons: code points of Fork Awesome 1.2 as UTF-8 text, by what they stand for here.

namespace sinew::editor::icon {

inline constexpr const char* pointer = "\uf245";
inline constexpr const char* move = "\uf047";
inline constexpr const char* rotate = "\uf021";
inline constexpr const char* scale = "\uf065";
inline constexpr const char* box = "\uf096";
inline constexpr const char* lasso = "\uf040";
inline constexpr const char* brush = "\uf1fc";
inline constexpr const char* polygon = "\uf247";
inline constexpr const char* sphere = "\uf10c";
inline constexpr const char* volume = "\uf1b3";
inline constexpr const char* fixed = "\uf023";
inline constexpr const char* handle = "\uf256";
inline constexpr const char* rigid = "\uf1b2";
inline constexpr const char* stiffer = "\uf219";
inline constexpr const char* softer = "\uf043";
inline constexpr const char* free = "\uf09c";
inline constexpr const char* eye = "\uf06e";
inline constexpr const char* eye_closed = "\uf070";
inline constexpr const char* chevron_down = "\uf107";
inline constexpr const char* chevron_right = "\uf105";
inline constexpr const char* folder = "\uf114";
inline constexpr const char* file = "\uf016";
inline constexpr const char* up = "\uf062";
inline constexpr const char* home = "\uf015";
inline constexpr const char* search = "\uf002";
inline constexpr const char* close = "\uf00d";
inline constexpr const char* check = "\uf00c";
inline constexpr const char* warning = "\uf071";
inline constexpr const char* info = "\uf05a";
inline constexpr const char* open = "\uf115";
inline constexpr const char* plus = "\uf067";
inline constexpr const char* trash = "\uf014";
inline constexpr const char* play = "\uf04b";
inline constexpr const char* pause = "\uf04c";
inline constexpr const char* step_back = "\uf048";
inline constexpr const char* step_forward = "\uf051";
inline constexpr const char* to_start = "\uf049";
inline constexpr const char* to_end = "\uf050";
inline constexpr const char* key = "\uf084";
inline constexpr const char* cut = "\uf0c4";
inline constexpr const char* pin = "\uf08d";
inline constexpr const char* cube = "\uf1b2";

/// First and last code point of the font.
inline constexpr unsigned first = 0xf000, last = 0xf2ff;

}  // namespace sinew::editor::icon
