#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <iostream>

#include "app/card/again.h"
#include "app/card/card_options.h"
#include "app/card/card_picture.h"
#include "app/card/subjects.h"
#include "app/output/atomic_file.h"
#include "app/support/errors.h"
#include "app/support/interrupt.h"
#include "app/support/out_folder.h"
#include "app/support/progress.h"
#include "app/support/text.h"
#include "app/support/version.h"
#include "render/gl/context.h"
#include "render/image/image.h"
#include "sim/base/thread_pool.h"

namespace neve::app::card {

namespace {

namespace fs = std::filesystem;

/// "wet", "wet_powder"
std::string folder_name(const std::vector<Source>& sources) {
  std::vector<std::string> names;
  for (const Source& source : sources)
    if (names.empty() || names.back() != source.name) names.push_back(source.name);
  return joined(names, "_").substr(0, 100);
}

std::string words_of(const Card& card) {
  std::string text = card.subject.title + "\n";
  for (const Experiment& e : card.experiments) {
    std::string name = info_of(e.kind).name;
    name.resize(8, ' ');
    text += "  " + name + joined(e.words, ", ") +
            (e.failure.empty() ? "" : (e.words.empty() ? "" : ", ") + e.failure) + "\n";
  }
  return text;
}

Json json_of(const std::vector<Card>& cards) {
  Json json;
  json["version"] = version;
  json["cards"] = Json::array();
  for (const Card& card : cards) json["cards"].push_back(to_json(card));
  return json;
}

/// Whether a file has the numbers of cards.
bool has_numbers(const fs::path& file) {
  try {
    const Json json = parse_json(output::read_file(file));
    return json.is_object() && json.contains("version") && json.contains("cards");
  } catch (const nlohmann::json::exception&) {
    return false;
  } catch (const IoError&) {
    return false;
  }
}

/// A card that is made again loses nothing, and a picture of --out was named by a person.
/// @param texts  of the picture to come
void refuse_loss(const CardOptions& options, const fs::path& picture, const fs::path& numbers,
                 const render::PngText& texts) {
  std::error_code error;
  const bool is_named = !options.out.empty();
  std::vector<std::string> lost;
  const auto look_at = [&](const fs::path& file, bool is_ours) {
    if (!fs::exists(file, error)) return;
    if (!is_ours)
      throw UsageError("", file.string() + " was not made by neve card; this one would replace it",
                       "move it away, or name another file with --out");
    lost.push_back(file.string());
  };
  if (!is_named) look_at(picture, is_card(picture));
  look_at(numbers, has_numbers(numbers));
  if (options.replaces || is_named || lost.empty() || shows_cards(picture, texts)) return;
  if (!fs::exists(picture, error))
    throw UsageError("", numbers.string() + " has no picture that says of what it is",
                     "add --replace, or name another file with --out");
  throw UsageError("",
                   "there is a card of other scenes or settings; this one would replace " +
                       joined(lost, " and "),
                   "add --replace, or name another file with --out");
}

}  // namespace

int run(const CardOptions& options) {
  const std::vector<Source> sources = sources_of(options);
  std::vector<Subject> subjects;
  for (const Source& source : sources) subjects.push_back(source.subject);
  const fs::path picture = options.out.empty() ? out_folder() / folder_name(sources) / "card.png"
                                               : fs::path(options.out);
  const fs::path numbers = fs::path(picture).replace_extension(".json");
  const render::PngText texts = texts_of(sources);
  refuse_loss(options, picture, numbers, texts);
  catch_interrupts();
  Progress progress(std::cerr, options.verbosity, can_update_lines(STDERR_FILENO));
  // A missing backend is found before the experiments.
  const auto context = render::gl::open_context(options.backend);
  std::atomic<int> done = 0;
  const std::string all = std::to_string(subjects.size() * std::size(kinds));
  const std::vector<Card> cards = make_cards(subjects, options.threads, [&] {
    progress.line(std::to_string(++done) + "/" + all + " experiments");
  });
  progress.clear();
  ThreadPool pool(options.threads);
  render::Renderer renderer(*context, {}, &pool);
  const Json json = json_of(cards);
  const std::vector<std::uint8_t> png = render::encode_png(draw_cards(cards, renderer), texts);
  output::make_folder(picture.parent_path());
  const std::string text = to_text(json) + "\n";
  output::write_together(
      {{numbers, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}},
       {picture, png}});
  if (options.is_json) {
    std::cout << to_text(json) << "\n";
  } else if (options.verbosity != Verbosity::quiet) {
    for (const Card& card : cards) std::cout << words_of(card);
  }
  std::cout.flush();
  progress.note(picture.string() + " and " + numbers.filename().string());
  return exit_ok;
}

}  // namespace neve::app::card
