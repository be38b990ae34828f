#include "engine/gpu/png.h"

#include <png.h>

#include "engine/geometry/check.h"
#include "engine/geometry/error.h"

namespace sinew::gpu {

std::vector<std::byte> png_bytes(const Picture& picture) {
  CHECK(picture.width > 0 && picture.height > 0 &&
        picture.rgba.size() ==
            std::size_t{4} * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::byte> out(size);
  const int written = png_image_write_to_memory(&image, out.data(), &size, 0, picture.rgba.data(), 0, nullptr);
  CHECK(written != 0, std::string(image.message));
  out.resize(size);
  return out;
}

Picture read_png(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) throw file_error(path, "a PNG file", image.message);
  image.format = PNG_FORMAT_RGBA;
  constexpr png_uint_32 most = 16'384;
  Picture picture;
  std::string found;
  if (image.width > most || image.height > most) {
    found = std::to_string(image.width) + "x" + std::to_string(image.height);
  } else {
    picture.width = static_cast<int>(image.width);
    picture.height = static_cast<int>(image.height);
    picture.rgba.resize(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, nullptr, picture.rgba.data(), 0, nullptr) == 0) found = image.message;
  }
  png_image_free(&image);
  if (!found.empty()) throw file_error(path, "a PNG picture of at most 16384x16384", found);
  return picture;
}

}  // namespace sinew::gpu
