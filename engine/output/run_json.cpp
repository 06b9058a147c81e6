#include <sys/resource.h>

#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/output/files.hpp"
#include "engine/output/hash.hpp"
#include "engine/output/output.hpp"
#include "mpmfast_version.hpp"

namespace mpmfast {
namespace {

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const auto start = line.find_first_not_of(" \t", line.find(':') + 1);
    return start == std::string::npos ? "unknown" : line.substr(start);
  }
  return "unknown";
}

nlohmann::ordered_json contact_json(const RunSummary::Contact& contact) {
  return {{"nodes_peak", contact.nodes_peak},
          {"regressions", contact.regressions},
          {"mean_iterations", contact.mean_iterations},
          {"fallbacks", contact.fallbacks},
          {"unconverged", contact.unconverged},
          {"touching", contact.touching},
          {"doubtful", contact.doubtful},
          {"pair_nodes", contact.pair_nodes},
          {"pair_fallbacks", contact.pair_fallbacks},
          {"meetings", contact.meetings},
          {"screened", contact.screened},
          {"points_peak", contact.points_peak}};
}

}  // namespace

std::uint64_t peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == "VmHWM:" && status >> kibibytes) return kibibytes * 1024;
  }
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << 5; }

ProgramIdentity program_identity() { return {kVersion, kGit, kCompiler, kFlags}; }

std::string program_text() {
  return fmt::format("mpmfast {} ({}), {}, {}", kVersion, kGit, kCompiler, kFlags);
}

void write_run_json(const std::filesystem::path& folder, const RunSummary& summary) {
  nlohmann::ordered_json json;
  json["version"] = kVersion;
  json["git"] = kGit;
  json["compiler"] = kCompiler;
  json["flags"] = kFlags;
  json["cpu"] = processor_name();
  json["threads"] = summary.threads;
  json["command"] = summary.command;
  json["overrides"] = summary.overrides;
  json["resumes"] = summary.resumes;
  json["scene"] = summary.scene_name;
  if (!summary.resolved_yaml.empty())
    json["scene_hash"] =
        fmt::format("{:016x}", XXH64(summary.resolved_yaml.data(), summary.resolved_yaml.size(), 0));
  json["status"] = summary.status;
  json["reason"] = summary.reason;
  if (!summary.failed_by.empty()) json["failed_by"] = summary.failed_by;
  json["dimension"] = summary.dimension;
  json["particles"] = summary.particles;
  json["fields"] = summary.fields;
  json["nodes_active_peak"] = summary.nodes_active_peak;
  json["steps"] = summary.steps;
  json["time_s"] = summary.time;
  json["dt_min_s"] = summary.dt_min;
  json["dt_max_s"] = summary.dt_max;
  json["wall_s"] = summary.wall;
  json["particle_steps_per_s"] = summary.particle_steps_per_second;
  json["peak_memory_bytes"] = summary.peak_memory_bytes;
  json["seconds"] = nlohmann::ordered_json::object();
  for (const auto& [pass, seconds] : summary.seconds) json["seconds"][pass] = seconds;
  json["contact"] = contact_json(summary.contact);
  json["energy_error"] = summary.energy_error;
  if (summary.overlap) {
    json["overlap_m2"] = summary.overlap->area;
    json["inside_m2"] = summary.overlap->inside;
    json["particles_inside"] = summary.overlap->particles_inside;
  }
  if (summary.outflow)
    json["outflow"] = {{"particles", summary.outflow->particles},
                       {"kg", summary.outflow->mass},
                       {"J", summary.outflow->energy}};
  if (summary.splits) json["splits"] = {{"count", summary.splits->splits}, {"held", summary.splits->held}};
  json["warnings"] = all_warnings(summary);
  if (!summary.history.hash.empty())
    json["history"] = {{"rows", summary.history.rows}, {"hash", summary.history.hash}};
  json["checksum"] = summary.checksum;
  // A file name need not be UTF-8: what is not is replaced rather than losing the whole summary.
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  write_aside(folder / "run.json", json.dump(2, ' ', false, replace) + "\n");
}

}  // namespace mpmfast
