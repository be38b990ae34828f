# The two programs, and the makers of assets

# sinew-samples makes the sample shapes. What it is made of serves tests and benchmarks as well.
find_package(CLI11 REQUIRED)
file(GLOB SINEW_SAMPLES_SOURCES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/apps/samples/*.cpp)
list(REMOVE_ITEM SINEW_SAMPLES_SOURCES ${CMAKE_SOURCE_DIR}/apps/samples/main.cpp)
add_library(sinew_samples STATIC ${SINEW_SAMPLES_SOURCES})
target_link_libraries(sinew_samples PUBLIC sinew_geometry sinew_io)
# a * b + c is rounded twice on every machine: the samples are the same bytes everywhere.
target_compile_options(sinew_samples PRIVATE -ffp-contract=off)
add_executable(sinew-samples apps/samples/main.cpp)
target_link_libraries(sinew-samples PRIVATE sinew_samples CLI11::CLI11)
