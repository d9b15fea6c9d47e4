#pragma once

// All that a laboratory needs: it turns a case into a robot program, and measures what the robot cut. Link
// incise::laboratory. For single parts include the headers of one module: see README.md, "How it is built".
#include <incise/evaluation/comparison.hpp>
#include <incise/evaluation/evaluation.hpp>
#include <incise/imaging/photo_contours.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/entry_folder.hpp>
#include <incise/io/path_io.hpp>
#include <incise/laboratory/experiment.hpp>
#include <incise/registration/register_clouds.hpp>
#include <incise/robot/player.hpp>
#include <incise/storage/calibration_file.hpp>
#include <incise/storage/case_file.hpp>
#include <incise/storage/case_run.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/storage/run_files.hpp>
#include <incise/workflow/assess.hpp>
#include <incise/workflow/calibrate.hpp>
#include <incise/workflow/run.hpp>
#include <incise/workflow/study.hpp>
