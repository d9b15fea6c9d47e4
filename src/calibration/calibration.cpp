#include <incise/calibration/calibration.hpp>

namespace incise {

std::string_view to_string(CalibrationMethod method) {
  return method == CalibrationMethod::Paper ? "paper" : "fit";
}

}  // namespace incise
