//! `flexsc report --watch`: the page is written again when the scenario file is saved.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use super::html::escaped;
use super::study::Study;
use super::{ReportArgs, finished};
use crate::error::CliError;
use crate::{files, say, stop};

/// Period at which the file is looked at.
const PERIOD: Duration = Duration::from_millis(200);
/// End of the name of the file beside the page that has the number of its version, which pages from a disk may load.
const VERSION: &str = ".js";

/// Writes the page now and after each change of the scenario file, until the user stops it.
pub fn run(args: &ReportArgs) -> Result<(), CliError> {
    let version_file = PathBuf::from(format!("{}{VERSION}", args.out.display()));
    files::refuse_existing(&version_file, args.force)?;
    let mut good: Option<String> = None;
    let mut version = 0_u64;
    let mut before = None;
    say!("{}: written at each change of {}; Ctrl-C ends", args.out.display(), args.scenario.display());
    while !stop::stop_requested() {
        let content = fs::read(&args.scenario).ok();
        if before.as_ref() == Some(&content) {
            thread::sleep(PERIOD);
            continue;
        }
        before = Some(content);
        version += 1;
        let began = Instant::now();
        let script = script(&version_file, version);
        let made =
            Study::load(&args.scenario, &args.set).and_then(|study| finished(&study, None, script.clone()));
        let page = match made {
            Ok(page) => {
                say!("  {:.1} s, {}", began.elapsed().as_secs_f64(), verdict(&page.unmet));
                good = Some(page.html.clone());
                page.html
            }
            Err(CliError::Interrupted(_)) => break,
            Err(failure) => {
                let text = failure.to_string();
                say!("error: {text}");
                with_error(good.as_deref(), &text, &script)
            }
        };
        files::write(&args.out, page.as_bytes(), true)?;
        files::write(&version_file, format!("flexscVersion({version})\n").as_bytes(), true)?;
    }
    // There are no later versions. A file that cannot be removed stays.
    let _ = fs::remove_file(&version_file);
    Ok(())
}

fn verdict(unmet: &[String]) -> String {
    if unmet.is_empty() { "nothing missed".to_owned() } else { unmet.join("; ") }
}

/// Returns the script by which a page reloads when there is a later version. A page from a disk may load no data, but scripts.
fn script(version_file: &Path, version: u64) -> String {
    let name = version_file.file_name().unwrap_or_default().to_string_lossy().replace(['\\', '"', '<'], "");
    format!(
        "<script data-version=\"{version}\">\nfunction flexscVersion(n) {{ if (n !== {version}) location.reload(); }}\n\
         setInterval(function () {{\n  var s = document.createElement(\"script\");\n  s.src = \"{name}?\" + Date.now();\n  \
         s.onload = s.onerror = function () {{ s.remove(); }};\n  document.head.appendChild(s);\n}}, 500);\n</script>\n"
    )
}

/// Returns the last good page with an error above its title, or a page with the error alone.
fn with_error(good: Option<&str>, text: &str, script: &str) -> String {
    let error = format!("<div class=\"broken\">{}</div>\n", escaped(text));
    let Some(good) = good else {
        return format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>error</title>\n{script}</head>\n\
             <body>\n<main>\n{error}</main>\n</body>\n</html>\n"
        );
    };
    let (head, rest) = good.split_once("<script").unwrap_or((good, ""));
    let (_, rest) = rest.split_once("</script>\n").unwrap_or(("", rest));
    format!("{head}{script}{}", rest.replacen("<main>\n", &format!("<main>\n{error}"), 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_stands_above_the_last_good_page() {
        let page = |version| script(Path::new("a/study.html.js"), version);
        let good = format!("<head>{}</head><main>\n<h1>study</h1>", page(3));
        let found = with_error(Some(&good), "a < b", &page(4));
        assert!(found.contains("data-version=\"4\"") && !found.contains("data-version=\"3\""), "{found}");
        assert!(found.contains("<div class=\"broken\">a &lt; b</div>\n<h1>study</h1>"), "{found}");
        assert!(with_error(None, "a < b", &page(1)).contains("a &lt; b"));
    }
}
