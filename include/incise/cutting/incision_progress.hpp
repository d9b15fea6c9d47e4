#pragma once

#include <incise/cutting/carving.hpp>

#include <functional>
#include <vector>

namespace incise {

/// The tissue at one moment of the cut.
struct CutFrame {
  double time_s = 0.0;
  int step = 0;  ///< number of steps done
  ToolPose tool;
  bool is_tool_in = true;
  Points positions;  ///< N x 3, mm
};
inline void describe(Visitor& v, CutFrame& f) {
  v("time_s", f.time_s, "Time since the tool began to plunge.");
  v("step", f.step, "Number of steps done.", kNotNegative);
  v("tool", f.tool, "Pose of the tool.");
  v("is_tool_in", f.is_tool_in, "Whether the tool is in the tissue.");
  v("positions", f.positions, "Positions of the vertices.");
}

/// One line of the log of a cut.
struct CutStepLog {
  double time_s = 0.0;    ///< at the end of the step, since the tool began to plunge
  int iterations = 0;     ///< of the linear solver
  bool converged = true;  ///< whether the linear solve reached its tolerance
  std::size_t tets_in_contact = 0;
  std::size_t removed = 0;                ///< tets, loose fragments included
  std::size_t held_back_vertices = 0;     ///< vertices whose motion was shortened to CutSettings::max_step_mm
  std::size_t slipped = 0;                ///< bonds, or points, that slipped
  Vec3 tool_force_mn = Vec3::Zero();      ///< of the tissue on the tool
  Vec3 tool_torque_mn_mm = Vec3::Zero();  ///< of the tissue on the tool, about its tip
};
inline void describe(Visitor& v, CutStepLog& s) {
  v("time_s", s.time_s, "Time since the tool began to plunge.");
  v("iterations", s.iterations, "Iterations of the linear solver.");
  v("converged", s.converged, "Whether the linear solve reached its tolerance.");
  v("tets_in_contact", s.tets_in_contact, "Number of tets in contact.");
  v("removed", s.removed, "Number of tets removed in the step.");
  v("held_back_vertices", s.held_back_vertices, "Number of vertices whose motion was cut short.");
  v("slipped", s.slipped, "Number of bonds, or points, that slipped.");
  v("tool_force_mn", s.tool_force_mn, "Force of the tissue on the tool.");
  v("tool_torque_mn_mm", s.tool_torque_mn_mm, "Torque of the tissue on the tool, about its tip.");
}

/// An unfinished incision as a value: the state that, with model, path and settings, determines how it continues, and
/// the results so far.
struct IncisionProgress {
  CutState state;
  int relaxation_steps = 0;  ///< done since the tool came out; 0 while it is in
  std::vector<CutStepLog> steps;
  std::vector<CutFrame> frames;
  double wall_s = 0.0;  ///< spent so far, all processes together
};
inline void describe(Visitor& v, IncisionProgress& p) {
  v("state", p.state, "State of tissue and tool.");
  v("relaxation_steps", p.relaxation_steps, "Number of steps done since the tool came out.", kNotNegative);
  v("steps", p.steps, "The log, step by step.");
  v("frames", p.frames, "Moments kept for pictures.");
  v("wall_s", p.wall_s, "Time spent so far.");
}

/// Receives the progress at each renewal step (see is_renewal_step). A later call, even in another process, can
/// continue from it with the same bits. `is_interrupted`: the monitor has cancelled, and this is the last call.
using ProgressKeeper = std::function<void(const IncisionProgress& progress, bool is_interrupted)>;

}  // namespace incise
