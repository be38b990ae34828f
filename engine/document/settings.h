#pragma once
/// What a layer asks of the table of methods: its method, the values of its settings, and nothing that the method can't
/// do. The table comes from the application.

#include <span>

#include "engine/document/project.h"
#include "engine/geometry/deformer.h"

namespace sinew::document {

/// The method of a layer. Throws InputError where the table has none of that name.
const Method& method_of(const Layer& layer, std::span<const Method> methods);

/// Values for Method::make. Throws InputError: an unknown name, a value out of range, not whole, or no choice.
Settings settings_of(const Layer& layer, const Method& method);

/// All of the above for each layer that is on, and that the layer asks for nothing that its method does not know:
/// so that an edit is refused before a big input is read.
void check_layers(std::span<const Layer> layers, std::span<const Method> methods);

/// A setting given as "name=value" or, for one layer only, "N.name=value" (N from 1): stored in each layer that is on
/// and whose method has it. Throws InputError where no layer takes it.
void set_from_text(const std::string& text, Project& project, std::span<const Method> methods);

/// "PLACE: expected ..., found ..."; a layer or selection that came from no file is called `what`.
InputError place_error(const Place& place, const std::string& what, const std::string& expected,
                       const std::string& found);

}  // namespace sinew::document
