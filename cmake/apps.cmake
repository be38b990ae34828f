# The two programs, and the makers of assets

# sinew-samples makes the sample shapes. What it is made of serves tests and benchmarks as well.
find_package(CLI11 REQUIRED)
file(GLOB SINEW_SAMPLES_SOURCES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/apps/samples/*.cpp)
list(REMOVE_ITEM SINEW_SAMPLES_SOURCES ${CMAKE_SOURCE_DIR}/apps/samples/main.cpp)
add_library(sinew_samples STATIC ${SINEW_SAMPLES_SOURCES})
target_link_libraries(sinew_samples PUBLIC sinew_geometry sinew_io)
# The samples are the same bytes everywhere: a * b + c is rounded twice on every machine, and GCC 12 must not drop a
# rounding to float, which it does where it joins neighbouring double-float-double conversions into a vector.
target_compile_options(sinew_samples PRIVATE -ffp-contract=off -fno-tree-slp-vectorize)
add_executable(sinew-samples apps/samples/main.cpp)
target_link_libraries(sinew-samples PRIVATE sinew_samples CLI11::CLI11)

# sinew, the command line: links no window system. CLI11 is seen by one file of each program.
file(GLOB SINEW_SOURCES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/apps/sinew/*.cpp)
add_executable(sinew ${SINEW_SOURCES})
target_link_libraries(sinew PRIVATE sinew_document sinew_deformers sinew_gpu CLI11::CLI11 fmt::fmt)
set_source_files_properties(apps/sinew/command_line.cpp PROPERTIES COMPILE_DEFINITIONS SINEW_VERSION="${PROJECT_VERSION}")

# sinew-tets, the process that fills surfaces with tets: the only one that links TetGen, which has its own licence (AGPL)
# and ends its process on some surfaces. Its symbols are visible to the library, which calls terminatetetgen by name.
find_path(TETGEN_INCLUDE_DIR tetgen.h REQUIRED)
find_library(TETGEN_LIBRARY tet REQUIRED)
add_executable(sinew-tets apps/tets/main.cpp apps/tets/terminate.cpp)
target_include_directories(sinew-tets SYSTEM PRIVATE ${TETGEN_INCLUDE_DIR})
target_compile_definitions(sinew-tets PRIVATE TETLIBRARY)
target_link_libraries(sinew-tets PRIVATE sinew_common ${TETGEN_LIBRARY})
set_target_properties(sinew-tets PROPERTIES ENABLE_EXPORTS ON)
add_dependencies(sinew_deformers sinew-tets)  # which starts it

# The editor without its window: everything that can be tested without a display.
set(SINEW_EDITOR_CORE attribute_range background choosing coloring command_line commands export_notes figures keys legend lod
                      manipulation marks navigation normals onion point_set portal portraits preferences recovery repeatable
                      residuals session session_control session_drag session_edit session_examples session_files
                      session_hidden session_journal session_motion session_time tools view volume)
list(TRANSFORM SINEW_EDITOR_CORE PREPEND ${CMAKE_SOURCE_DIR}/apps/editor/)
list(TRANSFORM SINEW_EDITOR_CORE APPEND .cpp)
add_library(sinew_editor_core STATIC ${SINEW_EDITOR_CORE})
find_package(PkgConfig REQUIRED)
pkg_check_modules(SYSTEMD REQUIRED IMPORTED_TARGET libsystemd)  # sd-bus, for the desktop's file dialog
target_link_libraries(sinew_editor_core PUBLIC sinew_document sinew_deformers sinew_gpu PRIVATE fmt::fmt PkgConfig::SYSTEMD)

# sinew-editor, the window: the rest of apps/editor.
if(SINEW_EDITOR AND EXISTS ${CMAKE_SOURCE_DIR}/apps/editor/main.cpp)
  find_package(glfw3 3.3 REQUIRED CONFIG)
  pkg_check_modules(IMGUI REQUIRED IMPORTED_TARGET imgui)
  file(GLOB SINEW_EDITOR_SOURCES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/apps/editor/*.cpp)
  list(REMOVE_ITEM SINEW_EDITOR_SOURCES ${SINEW_EDITOR_CORE})
  add_executable(sinew-editor ${SINEW_EDITOR_SOURCES})
  target_link_libraries(sinew-editor PRIVATE sinew_editor_core PkgConfig::IMGUI glfw CLI11::CLI11 fmt::fmt)
  target_compile_definitions(sinew-editor PRIVATE SINEW_VERSION="${PROJECT_VERSION}")
  # Events and Vulkan's structures are begun with some of their members; the rest is zero.
  target_compile_options(sinew-editor PRIVATE -Wno-missing-field-initializers)
endif()
