// Programs that users write, as a parameter has them: the name of a file, or a line with it and the text behind.
#pragma once

#include <string>
#include <string_view>

namespace models {

/// What messages call a program: its first line.
std::string_view program_name(std::string_view program);

/// The text behind the name, or that of the file: of one of that path, or else of that name in the data folder
/// models/programs. Throws sim::InputError for what cannot be read, and for a text of more than 1 MiB.
std::string program_text(std::string_view program);

/// Throws sim::InputError where a kind of entry was asked for, as the program's text declares what its entries hold.
void refuse_entry_kind(std::string_view program, std::string_view entry);

} // namespace models
