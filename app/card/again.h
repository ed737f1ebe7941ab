#pragma once
/// Cards as texts of their picture, and cards that are made again from one.

#include <filesystem>
#include <string>
#include <vector>

#include "app/card/subjects.h"
#include "render/image/image.h"

namespace neve::app::card {

/// Returns the texts of a picture of the first scene, with the scenes of all cards.
render::PngText texts_of(const std::vector<Source>& sources);

/// Whether a file is a picture made by neve card.
bool is_card(const std::filesystem::path& picture);

/// Whether a picture shows the same cards: made again they are the same.
/// @param texts  of theirs, see texts_of()
bool shows_cards(const std::filesystem::path& picture, const render::PngText& texts);

/// The cards of a picture; none where it shows no cards.
/// @param origin     of the picture
/// @param overrides  of the command line
/// @throws Error for texts that neve did not write, UsageError, SceneError
std::vector<Source> cards_in(const timeline::Origin& origin,
                             const std::vector<std::string>& overrides);

}  // namespace neve::app::card
