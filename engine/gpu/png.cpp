#include "engine/gpu/png.h"

#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "engine/geometry/check.h"
#include "engine/geometry/error.h"

namespace sinew::gpu {

void write_png(const std::string& path, const Picture& picture) {
  CHECK(picture.width > 0 && picture.height > 0 &&
        picture.rgba.size() ==
            std::size_t{4} * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  const std::string temporary = path + ".part";
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGBA;
  errno = 0;
  bool written = png_image_write_to_file(&image, temporary.c_str(), 0, picture.rgba.data(), 0, nullptr) != 0;
  std::string found = errno != 0 ? std::strerror(errno) : image.message;
  if (written && std::rename(temporary.c_str(), path.c_str()) != 0) {
    written = false;
    found = std::strerror(errno);
  }
  png_image_free(&image);
  if (written) return;
  std::remove(temporary.c_str());
  throw file_error(path, "a file that can be written", found);
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
