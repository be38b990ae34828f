# What the user made: projects, edits, undo, the solver's thread, reports. nlohmann-json is seen by json_parse.cpp alone.
sinew_layer(sinew_document engine/document sinew_io)
target_link_libraries(sinew_document PRIVATE nlohmann_json::nlohmann_json)
