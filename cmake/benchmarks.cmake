# sinew-bench: the papers' tables.
find_package(benchmark REQUIRED)
file(GLOB SINEW_BENCH_SOURCES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/benchmarks/*.cpp)
add_executable(sinew-bench ${SINEW_BENCH_SOURCES})
target_link_libraries(sinew-bench PRIVATE sinew_document sinew_deformers sinew_samples benchmark::benchmark fmt::fmt
                                          nlohmann_json::nlohmann_json)
target_compile_definitions(sinew-bench PRIVATE SINEW_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
add_dependencies(sinew-bench sinew-tets)
