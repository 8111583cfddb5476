# kerf_page(TARGET)
# Builds the page of web/ and puts it into TARGET, as it is served (tools/build_page.sh).
function(kerf_page target)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/src/* ${PROJECT_SOURCE_DIR}/web/public/*)
  set(page ${PROJECT_BINARY_DIR}/page)
  add_custom_command(
    OUTPUT ${page}/page_table.cpp ${page}/page_bytes.S
    COMMAND ${PROJECT_SOURCE_DIR}/tools/build_page.sh ${page}
    DEPENDS ${sources} ${PROJECT_SOURCE_DIR}/web/index.html ${PROJECT_SOURCE_DIR}/web/package-lock.json
            ${PROJECT_SOURCE_DIR}/web/vite.config.ts ${PROJECT_SOURCE_DIR}/tools/build_page.sh
            ${PROJECT_SOURCE_DIR}/tools/in_web.sh ${PROJECT_SOURCE_DIR}/tools/embed_page.mjs
    COMMENT "Building the page"
    VERBATIM)
  # CMake does not look into an .incbin.
  set_source_files_properties(${page}/page_bytes.S PROPERTIES OBJECT_DEPENDS ${page}/page_table.cpp)
  target_sources(${target} PRIVATE ${page}/page_table.cpp ${page}/page_bytes.S)
endfunction()
