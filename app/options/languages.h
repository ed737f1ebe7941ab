#pragma once
/// The languages of values that several commands take.

#include <algorithm>
#include <string>
#include <vector>

#include "app/advice/suggest.h"
#include "app/options/option.h"
#include "app/scene/names.h"
#include "app/scene/toml/value.h"
#include "app/setup/plan.h"
#include "app/support/errors.h"
#include "app/support/text.h"

namespace neve::app::options {

/// A text as it is. @param check  throws UsageError for one that cannot be used
using Check = std::function<void(const std::string& flag, const std::string& text)>;
Language<std::string> text(const std::string& type, const std::string& example = "",
                           const Check& check = {});

/// The folder of outputs. @param example  of a file in it: names of files are refused then
Language<std::string> folder(const std::string& example = "");
/// A folder that exists.
Language<std::string> existing_folder(const std::string& content);
/// A scene by its name, with or without ".toml"; "-" is standard input.
Language<std::string> scene_file();

/// A number between two bounds. @param expected  "a number of frames, or 0 for none"
template <class Number>
Language<Number> number(const std::string& type, double least, double most,
                        const std::string& expected) {
  const std::string example = scene::toml::number_text(std::min(least + 2, most));
  const auto read = [=](const std::string& flag, const std::string& text) {
    const std::optional<Number> value = number_of<Number>(text);
    const auto number = static_cast<double>(value.value_or(0));
    if (value && number >= least && number <= most) return *value;
    throw UsageError(flag, "cannot use \"" + text + "\"", "expected " + expected);
  };
  if constexpr (std::is_integral_v<Number>)
    return {type, example, read, [](const Number& value) { return std::to_string(value); }};
  else
    return {type, example, read, scene::toml::number_text};
}

/// Numbers of frames: "1-48", or "48" for all up to 48.
Language<setup::FrameRange> frames();
/// "1280x720"
Language<scene::PictureSize> size();
/// "0.25s" or "0.25": seconds.
Language<double> time();
/// "0.1,0.2s": such times, each later than the one before.
Language<std::vector<double>> times();
/// A number of at least 1: cells are so many times as large.
Language<double> coarsening();

/// One function reads the value, and another writes it.
template <class Read, class Write>
auto language(const std::string& type, const std::string& example, Read read, Write write) {
  using T = decltype(read(std::string()));
  return Language<T>{type, example,
                     [read](const std::string&, const std::string& text) { return read(text); },
                     [write](const T& value) { return std::string(write(value)); }};
}

/// One of the names of an enumeration. @param context  in app/advice/words.txt
template <scene::Choice E>
Language<E> choice(const std::string& type, const std::string& context = "") {
  return {type, scene::choices<E>().back(),
          [context](const std::string& flag, const std::string& text) {
            if (const std::optional<E> value = scene::value_named<E>(text)) return *value;
            throw UsageError(flag, "there is no \"" + text + "\"",
                             advice::suggest_one_of(text, {context, scene::choices<E>()}));
          },
          [](const E& value) { return std::string(scene::name(value)); }};
}

/// "a,b": each at most once, at least one.
template <class T>
Language<std::vector<T>> list(const std::string& type, const Language<T>& one) {
  return {type, one.example,
          [one](const std::string& flag, const std::string& text) {
            std::vector<T> values;
            for (const std::string& word : comma_separated(text)) {
              const T value = one.read(flag, word);
              if (std::find(values.begin(), values.end(), value) == values.end())
                values.push_back(value);
            }
            if (values.empty())
              throw UsageError(flag, "names nothing", "expected " + one.type + " or several");
            return values;
          },
          [one](const std::vector<T>& values) {
            std::string text;
            for (const T& value : values) text += (text.empty() ? "" : ",") + one.write(value);
            return text;
          }};
}

}  // namespace neve::app::options
