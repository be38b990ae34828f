#include "engine/gpu/sanitized.h"

#ifdef SINEW_SANITIZED

#include <dlfcn.h>

#include <initializer_list>

// What the driver and the layer leak, and races within the driver, which is not instrumented, are not ours.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libvulkan_lvp.so\nleak:libVkLayer_khronos_validation.so\nleak:libLLVM\n";
}
extern "C" const char* __tsan_default_options();
extern "C" const char* __tsan_default_options() {
  return "ignore_noninstrumented_modules=1";
}

namespace sinew::gpu {

void keep_drivers_loaded() {
  for (const char* library : {"libvulkan_lvp.so", "libVkLayer_khronos_validation.so"})
    dlopen(library, RTLD_LAZY | RTLD_NODELETE);
}

}  // namespace sinew::gpu

#else

namespace sinew::gpu {

void keep_drivers_loaded() {}

}  // namespace sinew::gpu

#endif
