#pragma once
/// The floor plan: every folder of sources, from the foundation up, and what it may include.
///
/// A folder may always include itself. Everything else is forbidden, so that a new arrow is a
/// decision and shows in the change that makes it.

#include <string_view>

namespace neve::test {

struct Folder {
  std::string_view path;
  std::string_view may_include;  ///< folders above in this table
  /// Namespace if it is not the path: the vocabulary that everything around uses has the name of
  /// the folder around it.
  std::string_view name_space = "";
};

inline constexpr Folder folders[] = {
    {"sim/base", "", "neve"},
    {"sim/types", "sim/base", "neve::sim"},
    {"sim/files", "sim/base sim/types"},
    {"sim/shapes", "sim/base sim/types sim/files"},
    {"sim/rigid", "sim/types sim/shapes"},
    {"sim/seeding", "sim/base sim/types sim/shapes"},
    {"sim/kernels", "sim/base sim/types sim/shapes"},
    {"sim/laws", "sim/types sim/kernels"},
    {"sim/kernels/instruction_sets", "sim/base sim/kernels sim/laws", "neve::sim::kernels"},
    {"sim/health", "sim/base sim/types sim/kernels sim/laws"},
    {"sim/state",
     "sim/base sim/types sim/shapes sim/rigid sim/seeding sim/kernels sim/laws sim/health",
     "neve::sim::engine"},
    {"sim/dust", "sim/base sim/types"},
    {"sim/engine",
     "sim/base sim/types sim/shapes sim/rigid sim/seeding sim/kernels sim/laws sim/health "
     "sim/state "
     "sim/dust"},
    {"sim", "sim/base sim/types sim/shapes sim/seeding sim/laws sim/dust sim/engine", "neve::sim"},
    {"sim/checks", "sim/base sim/types sim/shapes sim/rigid sim/seeding sim/laws sim/health sim"},
    {"render/image", "sim/base", "neve::render"},
    {"render/frame", "sim/base render/image", "neve::render"},
    {"render/shapes", "sim/base render/frame"},
    {"render/surface", "sim/base render/frame"},
    {"render/light", "sim/base render/frame"},
    {"render/gl", "sim/base render/image render/frame"},
    {"render/cpu", "sim/base render/frame render/light"},
    {"render/cpu/instruction_sets", "sim/base render/cpu", "neve::render::cpu"},
    {"render/overlay", "sim/base render/frame render/gl"},
    {"render/snow", "sim/base render/frame render/surface render/light render/cpu"},
    {"render/passes", "sim/base render/frame render/light render/gl render/cpu"},
    {"render/channels",
     "sim/base render/surface render/image render/frame render/light render/cpu"},
    {"render",
     "sim/base render/image render/frame render/light render/gl render/cpu render/overlay "
     "render/snow render/passes render/channels",
     "neve::render"},
    {"app/support", "", "neve::app"},
    {"app/scene/toml", "sim/base app/support"},
    {"app/advice", "app/support app/scene/toml"},
    {"app/scene",
     "sim/base sim/types sim/shapes sim/seeding sim/kernels sim/laws render/frame app/support "
     "app/scene/toml app/advice"},
    {"app/output", "sim/base sim/types sim sim/checks render/image app/support"},
    {"app/record",
     "sim/base sim/types sim sim/checks render/image app/support app/scene/toml app/scene "
     "app/output sim/shapes sim/rigid"},
    {"app/setup",
     "sim/base sim/types sim/shapes sim/rigid sim/seeding sim/kernels sim/laws sim/health sim "
     "app/support app/scene/toml app/advice app/scene app/output"},
    {"app/options",
     "render/gl app/support app/scene/toml app/advice app/scene app/output app/setup"},
    {"app/forecast",
     "sim/base sim/types sim/shapes sim/seeding sim/laws sim/health sim app/support "
     "app/scene/toml app/scene app/setup"},
    {"app/health",
     "sim/base sim/types sim/shapes sim/rigid sim/seeding sim/laws sim/health sim app/support "
     "app/scene/toml app/scene app/output app/setup app/forecast"},
    {"app/picture",
     "sim/base sim/types sim/shapes sim/rigid sim/laws sim/health sim render/frame render/shapes "
     "render/channels "
     "render app/support app/scene/toml app/scene app/setup app/health"},
    {"app/exports",
     "sim/base sim/types sim/shapes sim render/frame render/surface app/support app/scene/toml "
     "app/scene app/output app/setup app/picture"},
    {"app/timeline",
     "sim/base sim/kernels sim app/support app/scene/toml app/scene app/output app/record "
     "app/setup app/forecast app/health app/picture"},
    {"app/run",
     "sim/base sim/types sim/shapes sim sim/checks render/image render/frame render/gl "
     "render/channels render "
     "app/support app/scene/toml app/advice app/scene app/output app/record app/setup app/options "
     "app/forecast app/health app/picture app/exports app/timeline"},
    {"app/compare",
     "sim/base sim/types sim render/image render/frame render/gl render app/support app/scene/toml "
     "app/advice app/scene app/output app/record app/setup app/picture app/timeline app/run"},
    {"app/predict",
     "sim/types sim/laws sim app/support app/scene app/record app/setup app/forecast app/health "
     "app/timeline"},
    {"app/card",
     "sim/base sim/types sim/kernels sim/laws sim/health sim render/image render/frame render/gl "
     "render app/support app/advice app/scene app/output app/record app/setup app/options "
     "app/picture "
     "app/timeline app/run"},
    {"app/dump",
     "sim/base sim/types sim/health sim app/support app/scene/toml app/advice app/scene app/record "
     "app/setup app/health app/exports app/run"},
    {"app/sweep", "app/scene app/setup"},
    {"app/sweep/read",
     "app/support app/scene/toml app/advice app/scene app/setup app/options app/sweep"},
    {"app/sweep/plan",
     "sim/base sim/types app/support app/scene/toml app/scene app/output app/record app/setup "
     "app/options app/forecast app/health app/picture app/timeline app/run app/predict app/sweep "
     "app/sweep/read"},
    {"app/sweep/store",
     "sim/base app/support app/scene/toml app/scene app/output app/record app/setup app/options "
     "app/run app/predict app/sweep/read app/sweep/plan"},
    {"app/sweep/jobs",
     "sim app/support app/output app/record app/setup app/options app/run app/sweep/plan "
     "app/sweep/store"},
    {"app/sweep/sheet",
     "render/image render/frame render/gl render/overlay render app/support app/scene app/output "
     "app/record "
     "app/setup app/options app/picture app/predict app/sweep/plan app/sweep/store "
     "app/sweep/jobs"},
    {"app/pick/search", "sim/base app/sweep/plan"},
    {"app/pick",
     "render/frame render/overlay app/support app/scene/toml app/scene app/output app/record "
     "app/setup app/options "
     "app/sweep app/sweep/read app/sweep/plan app/sweep/store app/sweep/jobs app/pick/search"},
    {"app/view/session",
     "sim/types sim app/support app/scene/toml app/scene app/output app/record app/setup "
     "app/options app/forecast app/health app/picture app/timeline app/run app/dump app/sweep/plan "
     "app/sweep/store app/sweep/jobs"},
    {"app/view/frontend", "render/image render"},
    {"app/view/web", "render/image render app/support app/output app/view/frontend"},
    {"app/view/panels",
     "render/frame render/overlay render app/support app/scene/toml app/scene app/record "
     "app/health app/picture app/view/session app/view/frontend"},
    {"app/view/replay",
     "sim/base render/image render/frame render app/support app/scene/toml app/advice app/scene "
     "app/output "
     "app/view/frontend app/view/panels"},
    {"app/view/picker",
     "render/image render/frame render/overlay render app/support app/scene app/output app/setup "
     "app/options app/pick/search app/pick app/view/frontend app/view/panels"},
    {"app/view",
     "render/image render/frame render app/support app/scene app/output app/record app/setup "
     "app/picture app/run app/view/session app/view/frontend app/view/panels"},
    {"app/bench",
     "sim/base sim/types sim/kernels sim/laws sim render/image render/frame render/shapes "
     "render/surface "
     "render/gl render/cpu render app/support app/scene/toml app/scene app/output app/record "
     "app/setup app/picture app/sweep/plan app/sweep/store app/sweep/jobs app/view"},
    {"app/cli/devices",
     "render/gl app/support app/scene/toml app/scene app/view/frontend app/view/web "
     "app/view/replay app/view"},
    {"app/cli",
     "sim/base sim/shapes sim/seeding sim/kernels sim sim/checks render/image render/gl "
     "render/overlay render app/support app/scene/toml app/advice app/scene app/output app/record "
     "app/setup app/options "
     "app/forecast "
     "app/health app/picture app/exports app/timeline app/run app/predict app/card app/compare "
     "app/dump "
     "app/sweep/read "
     "app/sweep/plan app/sweep/store app/sweep/jobs app/sweep/sheet app/pick/search app/pick "
     "app/view/picker app/view app/bench app/cli/devices"},
    {"app", "app/output app/cli", "neve::app"},
};

/// Units (a header, a source or both) that a folder may hold before it wants a cut.
inline constexpr int max_units = 26;

}  // namespace neve::test
