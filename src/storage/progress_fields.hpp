#pragma once

#include <incise/procedure/incision_progress.hpp>

namespace incise {

// All fields of an incision's progress, in the order in which a checkpoint holds them: the one list, from which writing (a `Fields` that
// puts) and reading (one that takes) both follow. `Fields` has operator() for a single value, list() for a list of any length, per_vertex()
// and per_tet() for lists as long as the mesh, per_viscous_tet() and per_branch() for what viscous tissue remembers, and ascending() for items
// in the order of their tets, each tet once; the lists are given what to do with one item. A value may be const or not.

template <class Fields, class Value>
void walk_pose(Fields& f, Value& tool) {
  f("tip_mm", tool.tip_mm);
  f("axis", tool.axis);
  f("heading", tool.heading);
}

template <class Fields, class Value>
void walk_tissue(Fields& f, Value& tissue) {
  const auto matrix = [&f](auto& m) { f("matrix", m); };
  f.per_vertex("positions", tissue.positions, [&f](auto& p) { f("position", p); });
  f.per_tet("rotations", tissue.rotations, matrix);
  f.per_tet("is_live", tissue.is_live, [&f](auto& mark) { f("mark", mark); });
  f.per_viscous_tet("strains", tissue.memory.strains, matrix);
  f.per_branch("branches", tissue.memory.branches, matrix);
}

template <class Fields, class Value>
void walk_state(Fields& f, Value& state) {
  walk_tissue(f, state.tissue);
  f.per_tet("dose", state.dose, [&f](auto& dose) { f("dose", dose); });
  f.per_tet("tear_dose", state.tear_dose, [&f](auto& dose) { f("dose", dose); });
  f.ascending("bonds", state.bonds, [&f](auto& bond) {
    f("tet", bond.tet);
    f("offset_mm", bond.offset_mm);
  });
  walk_pose(f, state.tool);
  f("time_s", state.time_s);
  f("step", state.step);
  f.list("removals", state.record.removals, [&f](auto& removal) {
    f("tet", removal.tet);
    f("step", removal.step);
    f("time_s", removal.time_s);
    f("cause", removal.cause);
    f("centroid_mm", removal.centroid_mm);
    f("rest_volume_mm3", removal.rest_volume_mm3);
  });
}

template <class Fields, class Value>
void walk_step(Fields& f, Value& step) {
  f("time_s", step.time_s);
  f("iterations", step.iterations);
  f("converged", step.converged);
  f("tets_in_contact", step.tets_in_contact);
  f("removed", step.removed);
  f("held_back_vertices", step.held_back_vertices);
  f("slipped", step.slipped);
  f("tool_force_mn", step.tool_force_mn);
  f("tool_torque_mn_mm", step.tool_torque_mn_mm);
}

template <class Fields, class Value>
void walk_frame(Fields& f, Value& frame) {
  f("time_s", frame.time_s);
  walk_pose(f, frame.tool);
  f("is_tool_in", frame.is_tool_in);
  f.per_vertex("positions", frame.positions, [&f](auto& p) { f("position", p); });
  f.per_tet("is_live", frame.is_live, [&f](auto& mark) { f("mark", mark); });
}

template <class Fields, class Value>
void walk_progress(Fields& f, Value& progress) {
  walk_state(f, progress.state);
  f("relaxation_steps", progress.relaxation_steps);
  f.list("steps", progress.steps, [&f](auto& step) { walk_step(f, step); });
  f.list("frames", progress.frames, [&f](auto& frame) { walk_frame(f, frame); });
  f("wall_s", progress.wall_s);
}

}  // namespace incise
