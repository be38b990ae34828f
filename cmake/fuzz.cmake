# Fuzz targets: tests/fuzz/fuzz_FORMAT.cpp becomes fuzz_FORMAT, with a dictionary FORMAT.dict and seeds/FORMAT beside it.
# Configure with clang and -DSINEW_FUZZ=ON -DSINEW_SANITIZE=address,undefined; run as
#   bin/fuzz_obj -dict=tests/fuzz/obj.dict FOLDER_FOR_NEW_INPUTS tests/fuzz/seeds/obj
if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  message(FATAL_ERROR "SINEW_FUZZ needs clang: -DCMAKE_CXX_COMPILER=clang++")
endif()
if(NOT SINEW_SANITIZE)
  message(FATAL_ERROR "SINEW_FUZZ needs -DSINEW_SANITIZE=address,undefined")
endif()
target_compile_options(sinew_common INTERFACE -fsanitize=fuzzer-no-link -Wno-unknown-warning-option)

function(sinew_fuzz format)
  add_executable(fuzz_${format} ${CMAKE_SOURCE_DIR}/tests/fuzz/fuzz_${format}.cpp)
  target_link_libraries(fuzz_${format} PRIVATE sinew_io)
  target_link_options(fuzz_${format} PRIVATE -fsanitize=fuzzer)
endfunction()

sinew_fuzz(obj)
sinew_fuzz(off)
sinew_fuzz(xyz)
sinew_fuzz(pcd)
sinew_fuzz(ply)
sinew_fuzz(stl)
sinew_fuzz(conf)
sinew_fuzz(csv)
sinew_fuzz(bgeo)
sinew_fuzz(vtk)
sinew_fuzz(vtp)
