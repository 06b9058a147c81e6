#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "commands.hpp"
#include "complain.hpp"
#include "tools/report/page.hpp"

namespace mpmfast {

int report_command(const CommandLine& line) {
  namespace fs = std::filesystem;
  const fs::path html = line.out.empty() ? fs::path(line.scene) / "report.html" : fs::path(line.out);
  const ReportResult result = write_report(line.scene, html);
  for (const std::string& notice : result.notices) complain("mpmfast: {}\n", notice);
  fmt::print("report           {} ({:.1f} MB)\n", html.string(), static_cast<double>(result.bytes) / 1e6);
  return 0;
}

}  // namespace mpmfast
