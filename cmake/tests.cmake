# One test program per layer, one .cpp per source file or behaviour.
find_package(GTest REQUIRED)
include(GoogleTest)

function(sinew_tests name folder)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE ${ARGN} GTest::gtest_main fmt::fmt nlohmann_json::nlohmann_json)
  target_compile_definitions(${name} PRIVATE SINEW_SOURCE_DIR="${CMAKE_SOURCE_DIR}" SINEW_BINARY_DIR="${CMAKE_BINARY_DIR}")
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 300)
endfunction()

sinew_tests(test_geometry tests/geometry sinew_geometry)
sinew_tests(test_io tests/io sinew_io)
sinew_tests(test_document tests/document sinew_document sinew_deformers)
sinew_tests(test_deformers tests/deformers sinew_deformers sinew_io)
