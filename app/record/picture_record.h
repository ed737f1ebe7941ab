#pragma once
/// Record of the origin of a picture, as text in the PNG.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/live_change.h"
#include "app/scene/scene.h"
#include "app/support/json.h"
#include "app/support/version.h"
#include "render/image/image.h"

namespace neve::app::record {

/// Moments of a picture made by neve strip.
struct StripRecord {
  std::vector<double> times;  ///< s, increasing, at least one
  int columns = 1, width = 1920;
};

struct PictureRecord {
  std::string scene;  ///< resolved, TOML
  std::vector<std::string> overrides;
  std::vector<scene::LiveChange> changes;  ///< made while the simulation ran, up to this picture
  double coarsening = 1;                   ///< factor of --coarsen
  std::vector<std::string> prediction;     ///< of --predict, lines of the caption; none without
  std::uint64_t seed = 0;
  std::string version;
  std::string build;       ///< see build_text(); empty in pictures of earlier versions
  std::string state_hash;  ///< 16 hexadecimal digits
  int frame = 0;
  std::string view;
  std::string quality;                       ///< draft, preview, final
  std::string lut;                           ///< of --lut; empty: none
  std::string plate;                         ///< of --plate; empty: none
  double shutter = 0;                        ///< degrees of motion blur; 0: none
  std::vector<std::string> passes;           ///< of --passes; none: only PNGs
  std::map<std::string, std::string> files;  ///< of the scene: path to content hash
  std::optional<StripRecord> strip;          ///< frame and state_hash are those of its last moment
  bool has_caption = true;                   ///< of a mosaic; views say it in their layers
  std::vector<std::string> cards;            ///< titles of a picture made by neve card
};

/// The record of a picture that is not a frame of one run: a sheet, a comparison, a slate.
struct SheetRecord {
  struct Scene {
    std::string name, text;  ///< "A", resolved TOML
  };
  std::string what;                ///< "a contact sheet of 12 runs"
  std::vector<std::string> lines;  ///< "scene       drop.toml": of what, as `neve info` prints it
  std::string version = app::version;
  std::vector<Scene>
      scenes;         ///< that it shows; none in sheets, whose runs have pictures with theirs
  std::string again;  ///< what makes it again; "" in sheets, which know no folder

  /// A line of a short name and a text; none for an empty text.
  void add(std::string name, const std::string& text);
};

render::PngText to_png_text(const SheetRecord& record);
/// Reads the record of a sheet; nothing for any other picture. @throws Error as read_picture_record
std::optional<SheetRecord> read_sheet_record(const std::filesystem::path& file);

render::PngText to_png_text(const PictureRecord& record);
Json to_json(const PictureRecord& record);

/// @param file  named in errors @throws Error when the texts are no record
PictureRecord picture_record_of(const render::PngText& text, const std::string& file);

/// Reads no other file: those of its scene are looked for with find_files().
/// @throws Error with exit_invalid_scene when the file is no PNG or OpenEXR file, or holds no or
/// broken records
PictureRecord read_picture_record(const std::filesystem::path& file);

/// True if the file starts like a PNG or an OpenEXR file.
bool is_picture(const std::filesystem::path& file);

}  // namespace neve::app::record
