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
