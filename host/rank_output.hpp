// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

/// The lines that a program prints for a person and for the launcher.
///
/// Under Open MPI 5 the standard error of a rank is a file. The launcher reads the files of its own host. A rank of
/// another host also sends its lines through mpirun, which may cut and mix them. So such a line carries the rank, its
/// length and a checksum, and the launcher leaves out what does not fit (scripts/launcher/job/job_stream.py).
/// scripts/launcher/job/open_mpi.py sets the variables. A rank on another host has SANDWALL_RELAY, the descriptor of
/// the way through mpirun, and SANDWALL_RANK_LOG, the path of its file. A rank on the launcher's host has
/// SANDWALL_RELAY_LOST in their place. It sends only the lines that its file does not take, such as those about a full
/// disk.
namespace host {

/// Writes `line`, which ends with a line feed, to standard error and to the launcher of another host, if there is one.
/// Throws nothing if it cannot be written; the line is then lost. Any thread.
void writeLine(std::string_view line);

/// Returns `text` as it goes through mpirun: `@rank 3 5 a1b2c3d4 hello`, without a line feed. `text` is one line.
[[nodiscard]] std::string relayedLine(int rank, std::string_view text);

/// Sends the name of the file that holds the output of this rank, if the launcher is on another host.
void sendRankLog();

/// Removes that file. Call it at a good end, because nobody needs the file then.
void removeRankLog();

}  // namespace host
