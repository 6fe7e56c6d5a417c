# Runs at install time; see install.cmake for `program`, `sources`, `build`, `version`, `data` (share, below the prefix).
set(prefix "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")

# Names of commands, in bin, of scripts that lie with their parts elsewhere.
function(link_command name script)
  file(MAKE_DIRECTORY "${prefix}/bin")
  file(CREATE_LINK "../${data}/raycache/tools/${script}" "${prefix}/bin/${name}" SYMBOLIC)
  message(STATUS "Installing: ${prefix}/bin/${name}")
endfunction()
link_command(raycache-report report.py)
link_command(raycache-plot-sweep plot_sweep)
link_command(raycache-plot-quality plot_quality)
link_command(raycache-plot-curve plot_curve)
link_command(raycache-plot-counters plot_counters)

# Where bash and zsh look for the completion of commands under this prefix.
foreach(place IN ITEMS "bash|bash-completion/completions/raycache" "zsh|zsh/site-functions/_raycache")
  string(REPLACE "|" ";" place "${place}")
  list(GET place 0 shell)
  list(GET place 1 file)
  execute_process(COMMAND ${program} completion ${shell} OUTPUT_VARIABLE script COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE "${prefix}/${data}/${file}" "${script}")
  message(STATUS "Installing: ${prefix}/${data}/${file}")
endforeach()

# Python finds packages of /usr in lib/python3/dist-packages, those of /usr/local in a folder of its own version.
set(packages lib/python3/dist-packages)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr/local")
  execute_process(COMMAND /usr/bin/python3 -c "import sys; print('%d.%d' % sys.version_info[:2])"
                  OUTPUT_VARIABLE python OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
  if(NOT failed)
    set(packages lib/python${python}/dist-packages)
  endif()
endif()
file(MAKE_DIRECTORY "${prefix}/${packages}/raycache")
file(COPY_FILE "${sources}/tools/install/raycache_package.py" "${prefix}/${packages}/raycache/__init__.py")
file(COPY_FILE "${sources}/traces/read_trace.py" "${prefix}/${packages}/raycache/traces.py")
message(STATUS "Installing: ${prefix}/${packages}/raycache (import raycache.traces)")

# One manual for the program, one for each subcommand, from their --help.
find_program(help2man help2man)
if(NOT help2man)
  message(WARNING "no manuals: help2man is missing; install the package help2man and install again")
  return()
endif()
set(manuals "${prefix}/${data}/man/man1")
file(MAKE_DIRECTORY "${manuals}")
set(work "${build}/manuals")
file(MAKE_DIRECTORY "${work}")

# `name`: raycache-compare; `words`: the arguments before --help.
function(manual name words description also)
  execute_process(COMMAND ${program} ${words} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
  # help2man would fill the lines of the examples: they go into a section of their own.
  string(REGEX REPLACE "\nExamples:\n.*$" "\n" text "${help}")
  string(REGEX MATCH "\nExamples:\n.*$" examples "${help}")
  string(REGEX REPLACE "^\nExamples:\n" "" examples "${examples}")
  string(REPLACE "\\" "\\e" examples "${examples}")
  file(WRITE "${work}/${name}.help" "${text}")
  file(WRITE "${work}/${name}.more" "[EXAMPLES]\n.nf\n${examples}.fi\n\n[SEE ALSO]\n${also}\n")
  # help2man runs one program, with --help and with --version.
  file(WRITE "${work}/${name}"
       "#!/bin/sh\n[ \"$1\" = --version ] && echo '${name} (raycache) ${version}' || cat '${work}/${name}.help'\n")
  file(CHMOD "${work}/${name}" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
  # Its date is that of the sources where a packager says so (SOURCE_DATE_EPOCH), else today's.
  execute_process(COMMAND ${help2man} --no-info --section 1 --manual "User Commands" --name "${description}"
                          --source "raycache ${version}" --include "${work}/${name}.more" --output "${manuals}/${name}.1"
                          "${work}/${name}" RESULT_VARIABLE failed ERROR_VARIABLE words_of_help2man)
  if(failed)
    message(WARNING "no manual ${name}.1: ${words_of_help2man}")
  else()
    message(STATUS "Installing: ${manuals}/${name}.1")
  endif()
endfunction()

execute_process(COMMAND ${program} completion commands OUTPUT_VARIABLE commands COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE ";" "," commands "${commands}")
string(REGEX MATCHALL "[^\n]+" commands "${commands}")
set(pages "")
foreach(line IN LISTS commands)
  string(REGEX MATCH "^[^ ]+" command "${line}")
  string(REGEX REPLACE "^[^ ]+ +" "" description "${line}")
  manual(raycache-${command} "${command}" "${description}" "raycache(1)")
  string(APPEND pages "raycache-${command}(1), ")
endforeach()
string(REGEX REPLACE ", $" "" pages "${pages}")
manual(raycache "" "why one sampling strategy makes GPU ray tracing faster than another, without a GPU" "${pages}")
file(REMOVE_RECURSE "${work}")
