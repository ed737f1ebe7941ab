#pragma once
/// Cards as one picture: two beside each other, more of them below.

#include <vector>

#include "app/card/card.h"
#include "render/renderer.h"

namespace neve::app::card {

/// @throws LimitError for more than the backend draws
render::Image draw_cards(const std::vector<Card>& cards, render::Renderer& renderer);

}  // namespace neve::app::card
