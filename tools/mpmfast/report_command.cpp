#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <system_error>

#include "commands.hpp"
#include "complain.hpp"
#include "exit_codes.hpp"
#include "tools/report/page.hpp"

namespace mpmfast {

int report_command(const CommandLine& line) {
  namespace fs = std::filesystem;
  const fs::path html = line.out.empty() ? fs::path(line.scene) / "report.html" : fs::path(line.out);
  std::error_code error;
  if (!line.out.empty() && !line.force && fs::is_regular_file(html, error)) {
    complain("mpmfast: {} exists (--force replaces it)\n", html.string());
    return kExitWrongInput;
  }
  const ReportResult result = write_report(line.scene, html);
  for (const std::string& notice : result.notices) complain("mpmfast: {}\n", notice);
  say("report           {} ({:.1f} MB)\n", html.string(), static_cast<double>(result.bytes) / 1e6);
  return 0;
}

}  // namespace mpmfast
