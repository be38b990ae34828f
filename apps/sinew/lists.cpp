#include <fmt/core.h>

#include "apps/sinew/command.h"
#include "deformers/methods.h"
#include "engine/document/json.h"
#include "engine/io/io.h"
#include "engine/io/motion.h"

namespace sinew::app {

namespace {

int print_formats() {
  for (const io::Format& format : io::formats()) {
    std::string extensions;
    for (const std::string& e : format.extensions) extensions += (extensions.empty() ? "." : " .") + e;
    fmt::print("{:<14}{:<20}{:<7}{}\n", format.name, extensions, format.write != nullptr ? "r w" : "r", format.help);
  }
  for (const io::MotionFormat& format : io::motion_formats())
    fmt::print("{:<14}{:<20}{:<7}{}\n", format.name, "." + format.extension, format.write != nullptr ? "r w" : "r",
               format.help);
  return Ok;
}

std::string range_of(const Setting& setting) {
  std::string out;
  if (setting.choices.empty()) {
    out = fmt::format("{:.12g}, {:.12g} to {:.12g}", setting.standard, setting.min, setting.max);
    return setting.unit.empty() ? out : out + " " + setting.unit;
  }
  for (std::size_t i = 0; i < setting.choices.size(); ++i)
    out += (i == 0 ? "" : " | ") + setting.choices[i] + (static_cast<double>(i) == setting.standard ? "*" : "");
  return out;
}

void print_methods() {
  for (const Method& method : methods()) {
    fmt::print("{}: {}\n", method.name, method.help);
    for (const Setting& setting : method.settings)
      fmt::print("  {:<18}{:<34}{}\n", setting.name, range_of(setting), setting.help);
  }
}

void print_methods_json() {
  document::JsonWriter out;
  const auto member = [&](const char* name, const auto& value) {
    out.key(name);
    write_value(out, value);
  };
  out.begin_array(false);
  for (const Method& method : methods()) {
    out.begin_object();
    member("method", method.name);
    member("help", method.help);
    out.key("settings");
    out.begin_array(false);
    for (const Setting& setting : method.settings) {
      out.begin_object();
      member("name", setting.name);
      member("standard", setting.standard);
      member("min", setting.min);
      member("max", setting.max);
      member("integer", setting.integer);
      member("unit", setting.unit);
      member("choices", setting.choices);
      member("help", setting.help);
      out.end_object();
    }
    out.end_array();
    out.end_object();
  }
  out.end_array();
  fmt::print("{}", out.result());
}

}  // namespace

std::function<int()> declare_formats(Arguments&) {
  return print_formats;
}

std::function<int()> declare_methods(Arguments& arguments) {
  const auto json = std::make_shared<bool>(false);
  arguments.flag("--json", *json, "As JSON");
  return [json] {
    *json ? print_methods_json() : print_methods();
    return Ok;
  };
}

}  // namespace sinew::app
