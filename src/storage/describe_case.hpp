#pragma once

#include "field_visitor.hpp"

#include <incise/storage/case_file.hpp>

namespace incise {

inline constexpr const char* kCaseSchemaName = "incise.case/1";

/// Visits every field of a case file in the order in which it is written: the one description of the format.
void describe_case(CaseFile& file, FieldVisitor& visitor);

}  // namespace incise
