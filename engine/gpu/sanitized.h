#pragma once
/// What sanitizer builds need of a software driver; elsewhere nothing.

namespace sinew::gpu {

/// Keeps driver and validation layer in memory until the program ends: the leak checker can name, and so excuse, only
/// what is still there. Called before an instance is made.
void keep_drivers_loaded();

}  // namespace sinew::gpu
