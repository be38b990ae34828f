# One test program per layer, one .cpp per source file or behaviour.
find_package(GTest REQUIRED)
include(GoogleTest)

# Tests are built quickly: what they test is optimised, they themselves are not.
set(SINEW_TEST_OPTIONS $<$<CONFIG:Release>:-O1>)

# GCC 12 warns of a line of its own header of AVX.
set_source_files_properties(${CMAKE_SOURCE_DIR}/tests/apps/editor_core_test.cpp PROPERTIES COMPILE_OPTIONS -Wno-uninitialized)

# A test program of the .cpp files that match `pattern`.
function(sinew_tests name pattern)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${pattern})
  if(NOT sources)
    return()
  endif()
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE ${ARGN} GTest::gtest_main fmt::fmt nlohmann_json::nlohmann_json)
  target_compile_options(${name} PRIVATE ${SINEW_TEST_OPTIONS})
  target_compile_definitions(${name} PRIVATE SINEW_SOURCE_DIR="${CMAKE_SOURCE_DIR}" SINEW_BINARY_DIR="${CMAKE_BINARY_DIR}")
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 300)
endfunction()

sinew_tests(test_geometry tests/geometry/*.cpp sinew_geometry)
sinew_tests(test_io tests/io/*.cpp sinew_io)
sinew_tests(test_document tests/document/*.cpp sinew_document sinew_deformers)
sinew_tests(test_deformers tests/deformers/*.cpp sinew_deformers sinew_io sinew_samples)
# What the benchmarks compare with is tested where the methods are.
target_sources(test_deformers PRIVATE ${CMAKE_SOURCE_DIR}/tests/benchmarks/mesh_ik.cpp)
sinew_tests(test_samples tests/apps/samples*_test.cpp sinew_samples sinew_document)
sinew_tests(test_editor_core tests/apps/editor_core*_test.cpp sinew_editor_core sinew_samples PkgConfig::SYSTEMD)
add_dependencies(test_editor_core sinew sinew-tets)
sinew_tests(test_sinew tests/apps/sinew_*test.cpp sinew_document sinew_deformers sinew_gpu sinew_samples)
add_dependencies(test_sinew sinew sinew-tets)
# What pictures show beside ours.
add_executable(sinew-mesh-ik tests/mesh_ik/main.cpp tests/benchmarks/mesh_ik.cpp)
target_link_libraries(sinew-mesh-ik PRIVATE sinew_document sinew_deformers)
sinew_tests(test_pictures tests/apps/pictures_test.cpp sinew_gpu)
add_dependencies(test_pictures sinew sinew-samples sinew-tets sinew-mesh-ik)
sinew_tests(test_house tests/house/*.cpp sinew_common)

# One run of all gpu tests: each start of the program proves anew that the validation layer catches a planted hazard.
find_package(glfw3 3.3 REQUIRED CONFIG)
file(GLOB SINEW_GPU_TESTS CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/tests/gpu/*.cpp)
add_executable(test_gpu ${SINEW_GPU_TESTS})
target_compile_options(test_gpu PRIVATE ${SINEW_TEST_OPTIONS})
target_link_libraries(test_gpu PRIVATE sinew_gpu glfw GTest::gtest_main)
add_test(NAME gpu COMMAND test_gpu)
set_tests_properties(gpu PROPERTIES LABELS gpu TIMEOUT 600)

# In place of a desktop whose file dialog the window asks.
add_executable(sinew-fake-portal tests/fake_portal/main.cpp)
target_link_libraries(sinew-fake-portal PRIVATE sinew_common PkgConfig::SYSTEMD)

# The window, used by mouse and keys on a screen of its own. They wait more than they work: the longest begin first, beside
# all others (scripts/test runs a few more tests at once than there are processors).
function(window_tests script)
  foreach(what ${ARGN})
    add_test(NAME editor_${what} COMMAND ${CMAKE_SOURCE_DIR}/tests/apps/${script} $<TARGET_FILE_DIR:sinew-editor> ${what})
    set_tests_properties(editor_${what} PROPERTIES LABELS window TIMEOUT 600 COST 1000 SKIP_RETURN_CODE 77)
  endforeach()
endfunction()
if(SINEW_EDITOR)
  window_tests(editor_test.sh story time splats motion cancel large storm)
  window_tests(editor_shapes_test.sh jet statue)
  window_tests(editor_recover_test.sh recover)
  window_tests(editor_see_test.sh see portal)
  window_tests(editor_select_test.sh select control)
  window_tests(editor_poses_test.sh poses horse)
endif()

# Programs of others that read what sinew writes. Only `ctest -C clients` knows these tests: they need large packages, or
# what is not a Debian package (scripts/check clients).
add_test(NAME client_blender CONFIGURATIONS clients
         COMMAND ${CMAKE_SOURCE_DIR}/tests/clients/blender.sh $<TARGET_FILE_DIR:sinew>)
add_test(NAME client_splat_transform CONFIGURATIONS clients
         COMMAND ${CMAKE_SOURCE_DIR}/tests/clients/splat_transform.sh $<TARGET_FILE_DIR:sinew>)
set_tests_properties(client_blender client_splat_transform PROPERTIES LABELS client TIMEOUT 900 SKIP_RETURN_CODE 77)

# Never losing work: saves and journals that are killed or fail at each of their system calls.
add_executable(sinew-saver tests/safety/saver.cpp)
target_link_libraries(sinew-saver PRIVATE sinew_document)
add_test(NAME safety_kills COMMAND ${CMAKE_SOURCE_DIR}/tests/safety/kill_test.sh $<TARGET_FILE_DIR:sinew-saver>)
set_tests_properties(safety_kills PROPERTIES LABELS safety TIMEOUT 300 SKIP_RETURN_CODE 77)
add_executable(sinew-editing tests/safety/editing.cpp)
target_link_libraries(sinew-editing PRIVATE sinew_editor_core)
add_dependencies(test_editor_core sinew-editing)
