#pragma once
/// A Slurm of one machine, started by hand, for tests: no systemd, no cgroups, no accounting. Its
/// ports and munged are the machine's, so there is one at a time.

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>

#include "app/output/process.h"
#include "tests/support/temporary_folder.h"

namespace neve::test {

class Slurm {
 public:
  /// The program that is missing, with its package; "" where none is.
  static std::string missing() {
    ::setenv("PATH", (std::string(std::getenv("PATH")) + ":/usr/sbin:/sbin").c_str(), 1);
    for (const char* name : {"slurmctld", "slurmd", "sbatch", "squeue", "scancel", "munged"})
      if (!app::output::find_program(name))
        return std::string("no ") + name +
               " in PATH (Debian: slurmctld, slurmd, slurm-client, munge)";
    return "";
  }

  Slurm() : turn_(::open(turns().c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    // Another test that waits for the jobs of this one's controller would wait for ever.
    ::flock(turn_, LOCK_EX);
    const std::string dir = folder_.path().string();
    folder_.write("slurm.conf", config(dir));
    ::setenv("SLURM_CONF", (dir + "/slurm.conf").c_str(), 1);
    is_up_ =
        shell("set -e; mkdir -p " + dir +
              "/{state,spool,log,run}\n"
              "install -d -o munge -g munge -m 0755 /run/munge\n"
              "install -d -o munge -g munge -m 0700 /var/log/munge /var/lib/munge\n"
              "munge -n </dev/null >/dev/null 2>&1 || { runuser -u munge -- $(command -v munged); "
              "touch run/started_munge; }\n"
              "slurmctld -f " +
              dir + "/slurm.conf; slurmd -f " + dir +
              "/slurm.conf\n"
              "for i in $(seq 100); do sinfo -h 2>/dev/null | grep -q idle && exit 0; "
              "sleep 0.2; done; exit 1");
  }
  ~Slurm() {
    // The daemons end by the ids that they wrote, never by name.
    shell("scancel --user=root; for f in slurmd slurmctld; do kill $(cat " +
          folder_.path().string() +
          "/run/$f.pid); done; sleep 1; "
          "[ -e run/started_munge ] && kill $(cat /run/munge/munged.pid)");
    ::unsetenv("SLURM_CONF");
    ::close(turn_);
  }
  Slurm(const Slurm&) = delete;
  Slurm& operator=(const Slurm&) = delete;

  bool is_up() const { return is_up_; }

 private:
  bool shell(const std::string& script) {
    // Daemons keep what they inherit open; nobody shall wait for them.
    return app::output::run_process("/bin/bash", {"-c", "exec >/dev/null 2>&1\n" + script},
                                    folder_.path())
               .exit_code == 0;
  }

  static std::filesystem::path turns() {
    return std::filesystem::temp_directory_path() / "neve_tests_slurm.lock";
  }

  static std::string config(const std::string& dir) {
    char host[256] = "";
    ::gethostname(host, sizeof host - 1);
    const std::string name = std::string(host).substr(0, std::string(host).find('.'));
    std::string text = "ClusterName=neve\nSlurmctldHost=" + name + "(127.0.0.1)\n";
    for (const char* line : {"SlurmUser=root",
                             "SlurmdUser=root",
                             "AuthType=auth/munge",
                             "CryptoType=crypto/munge",
                             "MpiDefault=none",
                             "ProctrackType=proctrack/pgid",
                             "TaskPlugin=task/none",
                             "SwitchType=switch/none",
                             "ReturnToService=2",
                             "SlurmctldPort=16817",
                             "SlurmdPort=16818",
                             "SchedulerType=sched/backfill",
                             "SelectType=select/cons_tres",
                             "SelectTypeParameters=CR_Core",
                             "AccountingStorageType=accounting_storage/none",
                             "JobAcctGatherType=jobacct_gather/none",
                             "JobCompType=jobcomp/none",
                             "MaxArraySize=5",
                             "KillWait=5",
                             "MinJobAge=300",
                             "RequeueExit=75",
                             "SchedulerParameters=sched_interval=2"})
      text += std::string(line) + "\n";
    for (const auto& [key, file] : {std::pair{"SlurmctldPidFile", "run/slurmctld.pid"},
                                    {"SlurmdPidFile", "run/slurmd.pid"},
                                    {"SlurmdSpoolDir", "spool"},
                                    {"StateSaveLocation", "state"},
                                    {"SlurmctldLogFile", "log/slurmctld.log"},
                                    {"SlurmdLogFile", "log/slurmd.log"}})
      text += std::string(key) + "=" + dir + "/" + file + "\n";
    return text + "NodeName=" + name +
           " NodeAddr=127.0.0.1 CPUs=2 RealMemory=1500 State=UNKNOWN\n" +
           "PartitionName=debug Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n";
  }

  TemporaryFolder folder_;
  int turn_;  ///< of this test; held while the file is open
  bool is_up_ = false;
};

}  // namespace neve::test
