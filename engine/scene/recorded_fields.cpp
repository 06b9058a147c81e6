#include "engine/scene/fields.hpp"

namespace mpmfast {

void MapReader::expects(const std::string& key, const Form& form) const {
  if (Recorder* recorder = value_.problems().recorder()) recorder->note(join(value_.path(), key), form);
}

void MapReader::otherwise(const std::string& key, std::string_view text) const {
  if (Recorder* recorder = value_.problems().recorder())
    recorder->note_standard(join(value_.path(), key), std::string(text));
}

void MapReader::otherwise(const std::string& key, double value, Measure kind) const {
  if (Recorder* recorder = value_.problems().recorder())
    recorder->note_standard(join(value_.path(), key), quantity_text(value, kind));
}

void MapReader::otherwise(const std::string& key, const Vec3& vector, Measure kind, int count) const {
  if (Recorder* recorder = value_.problems().recorder())
    recorder->note_standard(join(value_.path(), key), vector_text(vector, kind, count));
}

When::When(const Value& map, const std::string& condition)
    : recorder_(condition.empty() ? nullptr : map.problems().recorder()), path_(map.path()) {
  if (recorder_) recorder_->enter(path_, condition);
}

When::~When() {
  if (recorder_) recorder_->leave(path_);
}

}  // namespace mpmfast
