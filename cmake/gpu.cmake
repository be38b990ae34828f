# Vulkan: see engine/gpu. Shaders are compiled here, once, and live in the library as arrays of words.
find_package(Vulkan REQUIRED COMPONENTS glslangValidator)

file(GLOB shader_sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/shaders/*.vert ${CMAKE_SOURCE_DIR}/shaders/*.frag
     ${CMAKE_SOURCE_DIR}/shaders/*.comp)
set(shader_folder ${CMAKE_BINARY_DIR}/shaders)
file(MAKE_DIRECTORY ${shader_folder})
set(shader_headers)
set(shader_includes "")
set(shader_rows "")
foreach(source ${shader_sources})
  get_filename_component(file ${source} NAME)
  string(REPLACE "." "_" name ${file})
  add_custom_command(
    OUTPUT ${shader_folder}/${name}.h
    COMMAND Vulkan::glslangValidator -V --quiet --target-env vulkan1.3 --vn ${name} --depfile ${shader_folder}/${name}.d
            -o ${shader_folder}/${name}.h ${source}
    DEPENDS ${source}
    DEPFILE ${shader_folder}/${name}.d
    COMMENT "Compiling shader ${file}"
    VERBATIM)
  list(APPEND shader_headers ${shader_folder}/${name}.h)
  string(APPEND shader_includes "#include \"${name}.h\"\n")
  string(APPEND shader_rows "    {\"${file}\", ${name}},\n")
endforeach()
configure_file(${CMAKE_SOURCE_DIR}/cmake/shaders.cpp.in ${shader_folder}/shaders.cpp @ONLY)

sinew_layer(sinew_gpu engine/gpu sinew_geometry)
target_sources(sinew_gpu PRIVATE ${shader_folder}/shaders.cpp ${shader_headers})
target_include_directories(sinew_gpu PRIVATE ${shader_folder})
target_link_libraries(sinew_gpu PUBLIC Vulkan::Vulkan PRIVATE PNG::PNG)
# Vulkan's structures are begun with their sType alone; the rest is zero.
target_compile_options(sinew_gpu PRIVATE -Wno-missing-field-initializers)
