#pragma once
/// Flags and commands that other programs have, and parameters that are typed as flags.

#include <string>
#include <vector>

namespace neve::app::setup {

/// Advice for an unknown flag: "what it is here, and how to write it". "": nothing is known.
/// @param word   "--motion-blur", without a value
/// @param flags  of the command
std::string foreign_flag_advice(const std::string& word, const std::vector<std::string>& flags);

/// Advice for a word that no flag takes: "hardening=5". "": nothing is known.
std::string stray_word_advice(const std::string& word, const std::vector<std::string>& flags);

/// The command that does what another word says: "simulate". "": none.
std::string command_meant(const std::string& word);

}  // namespace neve::app::setup
