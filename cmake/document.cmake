sinew_layer(sinew_document engine/document sinew_io)
