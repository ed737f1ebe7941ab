#include "app/scene/foreign_names.h"

#include <algorithm>
#include <utility>

#include "app/support/lower_text.h"

namespace neve::app::scene {

namespace {

/// The first of our names that is known wins.
constexpr std::pair<const char*, const char*> names_elsewhere[] = {
    {"h", "cell_size"},
    {"dx", "cell_size"},
    {"resolution", "cell_size"},
    {"E", "youngs_modulus"},
    {"E0", "youngs_modulus"},
    {"lambda", "youngs_modulus"},
    {"nu", "poisson_ratio"},
    {"xi", "hardening"},
    {"theta_c", "critical_compression"},
    {"theta_s", "critical_stretch"},
    {"rho", "density"},
    {"mu", "friction"},
    {"mu", "youngs_modulus"},
    {"alpha", "flip_ratio"},
    {"implicit", "beta"},
    {"timestep", "dt"},
    {"ppc", "particles_per_cell"},
    {"omega", "angular_velocity"},
    {"spin", "angular_velocity"},
    {"center", "position"},
    {"position", "eye"},
    {"position", "center"},
    {"position", "direction"},
    {"translate", "center"},
    {"translation", "center"},
    {"location", "center"},
    {"rotate", "rotation"},
    {"orientation", "rotation"},
    {"pos", "center"},
    {"centre", "center"},
    {"look_at", "target"},
    {"focal_length", "fov"},
    {"frame", "time"},
    {"path", "file"},
    {"filename", "file"},
    {"units", "scale"},
    {"bodies", "body"},
    {"cube", "box"},
    {"ball", "sphere"},
    {"r", "radius"},
    {"diameter", "radius"},
    {"speed", "velocity"},
    {"particles", "particles_per_cell"},
    {"stickiness", "critical_stretch"},
    {"cohesion", "critical_stretch"},
    {"hardness", "youngs_modulus"},
    {"stiffness", "youngs_modulus"},
    {"softness", "youngs_modulus"},
    {"resolution", "size"},
    {"duration", "frames"},
    {"snow", "material"},
    {"colliders", "collider"},
    {"obstacle", "collider"},
    {"obstacles", "collider"},
    {"sun", "light"}};

struct FlagName {
  const char *key, *flag;
};

constexpr FlagName flags[] = {{"quality", "--quality final"}, {"folder", "--out DIR"},
                              {"directory", "--out DIR"},     {"out", "--out DIR"},
                              {"threads", "--threads 8"},     {"backend", "--backend egl"},
                              {"movie", "--movie h264"},      {"coarsen", "--coarsen 2"}};

struct ChoiceName {
  const char *address, *words;  ///< words have a blank on both sides
  const char* advice;
};

constexpr ChoiceName choices_elsewhere[] = {
    {"solver.transfer", " pic ", "PIC is transfer = \"flip\" with flip_ratio = 0"},
    {"solver.transfer", " pic-flip pic_flip picflip flip-pic flip_pic pic/flip flip/pic ",
     "flip is the mix of both: flip_ratio is the share of FLIP"},
    {"solver.transfer", " mpm ", "all of them are MPM; the paper's is \"flip\""},
    {"solver.transfer", " mls-mpm mlsmpm mls_mpm ", "did you mean \"mls\"?"},
    {"solver.precision", " float64 fp64 f64 64 ", "did you mean \"double\"?"},
    {"solver.precision", " float32 fp32 f32 32 single ", "did you mean \"float\"?"},
    {"solver.time_step", " implicit semi-implicit semi_implicit ",
     "semi-implicit steps are solver.beta = 1"},
    {"solver.time_step", " explicit ", "explicit steps are solver.beta = 0, the default"},
    {"solver.contact_at", " grid node ", "did you mean \"nodes\"?"},
    {"solver.kernel", " linear ",
     "with linear weights forces jump at the borders of cells; quadratic is the cheaper one"}};

std::string last_word(const std::string& address) {
  const std::size_t dot = address.rfind('.');
  return dot == std::string::npos ? address : address.substr(dot + 1);
}

}  // namespace

std::string our_name(const std::string& word, const std::vector<std::string>& known) {
  for (const auto& [other, ours] : names_elsewhere)
    if (word == other && std::find(known.begin(), known.end(), ours) != known.end()) return ours;
  return "";
}

std::string our_address(const std::string& address, const std::vector<std::string>& known) {
  const std::string word = last_word(address);
  const std::string table = address.substr(0, address.size() - word.size());
  std::vector<std::string> in_table, with_name;
  for (const std::string& one : known) {
    const std::string last = last_word(one);
    if (one == table + last) in_table.push_back(last);
    with_name.push_back(last);
  }
  if (const std::string ours = our_name(word, in_table); !ours.empty()) return table + ours;
  const std::string ours = table.empty() ? our_name(word, with_name) : "";
  for (const std::string& one : known)
    if (!ours.empty() && last_word(one) == ours) return one;
  return "";
}

std::string flag_advice(const std::string& key) {
  for (const FlagName& name : flags)
    if (key == name.key)
      return "it is a flag of the command line: neve render SCENE " + std::string(name.flag);
  return "";
}

std::string choice_advice(const std::string& address, const std::string& word) {
  const std::string wanted = " " + lower_text(word) + " ";
  for (const ChoiceName& choice : choices_elsewhere)
    if (address == choice.address &&
        std::string_view(choice.words).find(wanted) != std::string_view::npos)
      return choice.advice;
  return "";
}

}  // namespace neve::app::scene
