#include "render/image/mean_image.h"

namespace neve::render {

void MeanImage::add(const Image& image) {
  if (count_ == 0) {
    form_ = {image.width, image.height, image.channels, {}};
    sum_.assign(image.pixels.size(), 0);
  }
  if (image.width != form_.width || image.height != form_.height ||
      image.channels != form_.channels || image.pixels.size() != sum_.size())
    throw ImageError("the mean of pictures needs pictures of one size");
  ++count_;
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const bool is_weighted = channels == 4 && i % 4 != 3;
    sum_[i] += image.pixels[i] * (is_weighted ? image.pixels[i - i % 4 + 3] : 1u);
  }
}

Image MeanImage::mean() const {
  if (count_ == 0) throw ImageError("the mean of pictures needs at least one");
  Image image = form_;
  image.pixels.resize(sum_.size());
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const bool is_weighted = form_.channels == 4 && i % 4 != 3;
    const std::uint64_t whole = is_weighted ? sum_[i - i % 4 + 3] : count_;
    image.pixels[i] = static_cast<std::uint8_t>(whole == 0 ? 0 : (sum_[i] + whole / 2) / whole);
  }
  return image;
}

}  // namespace neve::render
