#include "app/view/frontend/key_names.h"

#include "app/view/frontend/frontend.h"

namespace neve::app::view::frontend {

namespace {

struct Named {
  const char* name;
  int key;
};

constexpr Named named_keys[] = {
    {"space", ' '},
    {"escape", key::escape},
    {"enter", key::enter},
    {"tab", key::tab},
    {"backspace", key::backspace},
    {"insert", key::insert},
    {"delete", key::del},
    {"right", key::right},
    {"left", key::left},
    {"down", key::down},
    {"up", key::up},
    {"page_up", key::page_up},
    {"page_down", key::page_down},
    {"home", key::home},
    {"end", key::end},
    {"shift", key::shift},
    {"ctrl", key::ctrl},
    {"alt", key::alt},
    {"super", key::super},
};

/// Keys are called by the character that they print without shift; GLFW's and the browsers' lists
/// agree here.
constexpr std::string_view signs = "'*+,-./;=[\\]`?#<";

}  // namespace

std::optional<int> key_named(const std::string& name) {
  if (name.size() == 1) {
    const char c = name[0];
    if (c >= 'a' && c <= 'z') return c - 'a' + 'A';
    if ((c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')) return c;
    if (c != 0 && signs.find(c) != std::string_view::npos) return c;
    return std::nullopt;
  }
  for (const Named& key : named_keys)
    if (name == key.name) return key.key;
  for (int k = 1; k <= 12; ++k)
    if (name == "f" + std::to_string(k)) return key::f1 + k - 1;
  return std::nullopt;
}

std::string key_name(int key) {
  if (key >= 'A' && key <= 'Z') return std::string(1, static_cast<char>(key - 'A' + 'a'));
  if (key > ' ' && key < 127 && key_named(std::string(1, static_cast<char>(key))) == key)
    return std::string(1, static_cast<char>(key));
  for (const Named& named : named_keys)
    if (key == named.key) return named.name;
  if (key >= key::f1 && key < key::f1 + 12) return "f" + std::to_string(key - key::f1 + 1);
  return {};
}

std::vector<std::string> key_names() {
  std::vector<std::string> names;
  for (const Named& key : named_keys) names.emplace_back(key.name);
  for (int k = 1; k <= 12; ++k) names.push_back("f" + std::to_string(k));
  return names;
}

}  // namespace neve::app::view::frontend
