#pragma once
/// Every key of a sweep file, once; see app/scene/describe.h for the visitor.

#include "app/scene/describe.h"
#include "app/sweep/read/sweep.h"

namespace neve::app::sweep::read {

template <class V>
void describe(V& visit, AxisRule& a) {
  using enum scene::Change;
  visit("values", a.values, scene::unit::none, scene::anything, restart, "The values, as a list.");
  visit("linspace", a.linspace, scene::unit::none, scene::within(1e30), restart,
        "num values at equal distances from the first number to the second.");
  visit("logspace", a.logspace, scene::unit::none, scene::above(0).at_most(1e30), restart,
        "num values in equal ratios from the first number to the second.");
  visit("range", a.range, scene::unit::none, scene::within(1e15), restart,
        "Whole numbers [first, last] or [first, last, step], both ends included.");
  visit("uniform", a.uniform, scene::unit::none, scene::within(1e30), restart,
        "Samples between the two numbers; for the methods that draw.");
  visit("log_uniform", a.log_uniform, scene::unit::none, scene::above(0).at_most(1e30), restart,
        "Samples between the two numbers, uniform in the logarithm; for the methods that draw.");
  visit("normal", a.normal, scene::unit::none, scene::within(1e30), restart,
        "Normal samples, with mean and standard deviation; for the methods that draw.");
  visit("num", a.num, scene::unit::none, scene::between(1, 100000), restart,
        "Number of values of linspace and logspace.");
  visit("label", a.label, scene::unit::none, scene::anything, restart,
        "Name of the axis on the sheet; default: the parameter's name.");
}

template <class V>
void describe(V& visit, SweepSettings& s) {
  using enum scene::Change;
  visit("scene", s.scene, scene::unit::none, scene::anything, restart,
        "Scene to vary; path relative to this file.");
  visit("method", s.method, scene::unit::none, scene::anything, restart,
        "grid: all combinations; zip: the axes in parallel; random, lhs (Latin hypercube), sobol "
        "(evenly spread; more samples keep the first ones): samples; morris: trajectories that "
        "change one axis at a time and tell the effect of each; list: only the [[run]]s.");
  visit(
      "samples", s.samples, scene::unit::none, scene::between(1, 100000), restart,
      "Number of runs of random, lhs and sobol; number of trajectories of morris, each of one run "
      "more than there are axes.");
  visit("seed", s.seed, scene::unit::none, scene::between(0, scene::max_count), restart,
        "Seed of the samples.");
  visit("seeds", s.seeds, scene::unit::none, scene::between(min_seeds, max_seeds), restart,
        "Runs of each point of the sweep, with the scene's seed and those after it: particles and "
        "lumps of snow are drawn anew in each. Tiles, table and plots then say what is noise.");
  visit("where", s.where, scene::unit::none, scene::anything, restart,
        "Conditions that all runs of the axes meet, as in [\"critical_stretch < 0.5 * "
        "critical_compression\"]: "
        "axes, numbers, a number * an axis.");
  visit("frames", s.frames, scene::unit::none, scene::anything, restart,
        "Frames to draw, \"A-B\" or \"N\" for all up to N; default: those of the scene.");
  visit("fork", s.fork, scene::unit::none, scene::anything, restart,
        "Time at which all runs fork, as \"0.8s\": the common start is simulated once; default: "
        "each run has its values from the start.");
  visit("keep_states", s.keep_states, scene::unit::none, scene::anything, restart,
        "Keep the state of each drawn frame: tiles of another size, view, colour or camera are "
        "then drawn without simulating.");
  visit("title", s.title, scene::unit::none, scene::anything, restart,
        "Title of the sheet; default: that of the scene.");
}

template <class V>
void describe(V& visit, SweepLimits& l) {
  using enum scene::Change;
  visit("timeout", l.timeout, scene::unit::second, scene::between(0, 1e9), restart,
        "Longest time of a run, in seconds or as \"20m\", \"1h30m\"; 0: none.");
  visit("memory", l.memory, scene::unit::bytes, scene::between(0, scene::max_count), restart,
        "Memory of a run, in bytes or as \"6GiB\"; 0: only the scene's own limit.");
  visit("runs", l.runs, scene::unit::none, scene::between(1, max_runs), restart,
        "Largest number of runs; a sweep with more is refused.");
}

template <class V>
void describe(V& visit, SheetSettings& s) {
  using enum scene::Change;
  visit("columns", s.columns, scene::unit::none, scene::anything, restart,
        "Address or label of the axis across; default: the last one.");
  visit("rows", s.rows, scene::unit::none, scene::anything, restart,
        "Address or label of the axis down; default: the one before the last.");
  visit("wrap", s.wrap, scene::unit::none, scene::between(0, 64), restart,
        "Tiles side by side, with one axis or none; 0: chosen from their number.");
  visit("tile", s.tile, scene::unit::pixels, scene::between(64, 4096), restart,
        "Width and height of a tile; default: 480 wide, in the shape of the scene's pictures.");
  visit("view", s.view, scene::unit::none, scene::anything, restart,
        "View on the tiles; default: the scene's first.");
  visit("label", s.label, scene::unit::none, scene::anything, restart,
        "Text on a tile. differences: the name and the parameters that differ; name: the name of "
        "the run; none: no text.");
  visit("framing", s.framing, scene::unit::none, scene::anything, restart,
        "What a camera without a place holds. sheet: the snow of all runs at the last frame, which "
        "the sheet shows; fall: all that the snow does, from the start; each: a camera for each "
        "run, which holds its own snow at the last frame.");
}

template <class V>
void describe(V& visit, SweepFile& s) {
  visit.section("sweep", "The scene and the method of the sweep.",
                [&](auto& v) { describe(v, s.sweep); });
  visit.addresses("set", s.set, "A parameter with the same value in all runs.");
  visit.addresses("axis", s.axis,
                  "A parameter that varies: a list of values, or a table with one of linspace, "
                  "logspace, range, uniform, log_uniform, normal.");
  visit.address_lists(
      "link", s.links,
      "Parameters that vary together as one axis; labels = [...] names its values.");
  visit.address_lists("run", s.runs, "Parameters of one run; label = \"...\" names it.");
  visit.section("limits", "Limits of a run; a run that exceeds one is stopped.",
                [&](auto& v) { describe(v, s.limits); });
  visit.section("sheet", "The contact sheet.", [&](auto& v) { describe(v, s.sheet); });
}

}  // namespace neve::app::sweep::read
