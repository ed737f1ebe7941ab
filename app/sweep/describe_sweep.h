#pragma once
/// Every key of a sweep file, once; see app/scene/describe.h for what a visitor has.

#include "app/scene/describe.h"
#include "app/sweep/sweep.h"

namespace neve::app {

template <class V>
void describe(V& visit, AxisSpec& a) {
  using enum Change;
  visit("values", a.values, unit::none, anything, restart, "The values, as a list.");
  visit("linspace", a.linspace, unit::none, within(1e30), restart,
        "num values at equal distances from the first number to the second.");
  visit("logspace", a.logspace, unit::none, above(0).at_most(1e30), restart,
        "num values in equal ratios from the first number to the second.");
  visit("range", a.range, unit::none, within(1e15), restart,
        "Whole numbers [first, last] or [first, last, step], both ends included.");
  visit("uniform", a.uniform, unit::none, within(1e30), restart,
        "Drawn between the two numbers; for the methods random and lhs.");
  visit("log_uniform", a.log_uniform, unit::none, above(0).at_most(1e30), restart,
        "Drawn between the two numbers so that all ratios are alike; for random and lhs.");
  visit("normal", a.normal, unit::none, within(1e30), restart,
        "Drawn about the first number, the second is the standard deviation; for random and lhs.");
  visit("num", a.num, unit::none, between(1, 100000), restart,
        "How many values linspace and logspace make.");
  visit("label", a.label, unit::none, anything, restart,
        "What the axis is called on the sheet; without it the parameter's name.");
}

template <class V>
void describe(V& visit, SweepSettings& s) {
  using enum Change;
  visit("scene", s.scene, unit::none, anything, restart,
        "The scene that is varied; relative to this file.");
  visit("method", s.method, unit::none, anything, restart,
        "grid: all combinations; zip: the axes in step; random, lhs: samples are drawn; list: only "
        "the [[run]]s.");
  visit("samples", s.samples, unit::none, between(1, 100000), restart,
        "How many runs random and lhs draw.");
  visit("seed", s.seed, unit::none, between(0, max_count), restart, "Of what is drawn.");
  visit("frames", s.frames, unit::none, anything, restart,
        "Frames to draw, \"A-B\" or \"N\" for 0-N; without it the scene's.");
  visit("title", s.title, unit::none, anything, restart,
        "Title of the sheet; without it the scene's.");
}

template <class V>
void describe(V& visit, SweepLimits& l) {
  using enum Change;
  visit("timeout", l.timeout, unit::second, between(0, 1e9), restart,
        "Longest time of a run, in seconds or as \"20m\", \"1h30m\"; 0: none.");
  visit("memory", l.memory, unit::bytes, between(0, max_count), restart,
        "Memory of a run, in bytes or as \"6GiB\"; 0: only the scene's own limit.");
  visit("runs", l.runs, unit::none, between(1, 1e6), restart,
        "Runs that a sweep may have before it is refused.");
}

template <class V>
void describe(V& visit, SheetSettings& s) {
  using enum Change;
  visit("columns", s.columns, unit::none, anything, restart,
        "Address or label of the axis that goes across; without it the last one.");
  visit("rows", s.rows, unit::none, anything, restart,
        "Address or label of the axis that goes down; without it the one before the last.");
  visit("wrap", s.wrap, unit::none, between(0, 64), restart,
        "Tiles side by side where there is one axis or none; 0: chosen by their number.");
  visit("tile", s.tile, unit::pixels, between(64, 4096), restart,
        "Width and height of a tile; without it 480 wide in the shape of the scene's pictures.");
  visit("view", s.view, unit::none, anything, restart,
        "The view that the tiles show; without it the scene's first.");
  visit("label", s.label, unit::none, anything, restart,
        "What stands on the tiles: differences: the name and the parameters that differ; name: the "
        "name of the run; none: nothing.");
}

template <class V>
void describe(V& visit, SweepFile& s) {
  visit.section("sweep", "What is varied and how.", [&](auto& v) { describe(v, s.sweep); });
  visit.addresses("set", s.set, "A parameter of the scene that is the same in all runs.");
  visit.addresses("axis", s.axis,
                  "A parameter that varies: a list of values, or a table with one of linspace, "
                  "logspace, range, uniform, log_uniform, normal.");
  visit.address_lists("link", s.links,
                      "Parameters that vary together and count as one axis; with labels = [...] "
                      "its values are called so.");
  visit.address_lists("run", s.runs,
                      "Parameters of one run; label = \"...\" is what it is called.");
  visit.section("limits", "What a run may use before it is stopped.",
                [&](auto& v) { describe(v, s.limits); });
  visit.section("sheet", "The contact sheet.", [&](auto& v) { describe(v, s.sheet); });
}

}  // namespace neve::app
