find_package(OpenMesh REQUIRED CONFIG)
sinew_layer(sinew_deformers deformers sinew_geometry)
