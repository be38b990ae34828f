find_package(OpenMesh REQUIRED CONFIG)
find_library(METIS_LIBRARY metis REQUIRED)
sinew_layer(sinew_deformers deformers sinew_geometry)
target_link_libraries(sinew_deformers PRIVATE ${METIS_LIBRARY} OpenMeshCore OpenMeshTools)
