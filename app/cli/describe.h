#pragma once
/// The options of the commands that no other part of the program calls; those of render and sweep
/// are beside their structs.

#include "app/cli/commands.h"
#include "app/options/option.h"

namespace neve::app::cli {

void describe_new(options::Command& visit, PlainOptions& o);
void describe_info(options::Command& visit, PlainOptions& o);
void describe_verify(options::Command& visit, PlainOptions& o);
void describe_doctor(options::Command& visit, PlainOptions& o);
void describe_schema(options::Command& visit, PlainOptions& o);
void describe_manual(options::Command& visit, PlainOptions& o);
void describe_version(options::Command& visit, PlainOptions& o);
void describe_help(options::Command& visit, PlainOptions& o);
void describe_params(options::Command& visit, ParamsOptions& o);

void describe_check(options::Command& visit, CheckCommand& command);
void describe_dump(options::Command& visit, dump::DumpOptions& o);
void describe_export(options::Command& visit, ExportCommand& o);
void describe_strip(options::Command& visit, run::StripOptions& o);
void describe_compare(options::Command& visit, CompareOptions& o);
void describe_pick(options::Command& visit, PickCommand& o);
void describe_view(options::Command& visit, view::ViewOptions& o);

}  // namespace neve::app::cli
