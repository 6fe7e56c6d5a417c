# What `cmake --install` brings beside the program: manuals, completion, documentation, report tools, the Python package.
include(GNUInstallDirs)

# The documentation keeps the folders of the sources, so that its links lead somewhere.
set(raycache_doc ${CMAKE_INSTALL_DATAROOTDIR}/doc/raycache)
install(FILES README.md CONTRIBUTING.md CHANGELOG.md LICENSE DESTINATION ${raycache_doc})
install(DIRECTORY docs DESTINATION ${raycache_doc})
install(FILES cachesim/MODEL.md DESTINATION ${raycache_doc}/cachesim)
install(FILES traces/FORMAT.md DESTINATION ${raycache_doc}/traces)

# Each lies with its parts under share/raycache/tools; a link in bin makes it a command.
install(PROGRAMS tools/report.py tools/plot_sweep tools/plot_quality tools/plot_curve tools/plot_counters DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/raycache/tools)
install(FILES tools/files.py tools/plots.py tools/report_numbers.py tools/report_charts.py tools/report_page.html
        DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/raycache/tools)
# Made at install time, from the program as it was built, for the prefix that is given then.
install(CODE "
  set(program \"$<TARGET_FILE:raycache>\")
  set(sources \"${CMAKE_SOURCE_DIR}\")
  set(build \"${CMAKE_BINARY_DIR}\")
  set(version \"${PROJECT_VERSION}\")
  set(data \"${CMAKE_INSTALL_DATAROOTDIR}\")
  include(\"${CMAKE_SOURCE_DIR}/tools/install/generate.cmake\")
")
