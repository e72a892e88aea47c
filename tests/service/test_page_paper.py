"""The page on paper and over slow lines, in a real browser."""
import base64
import re
import socket
import socketserver
import threading
import time

from test_page import find, find_all, until
from test_page_studies import submit

A4 = {"paperWidth": 8.27, "paperHeight": 11.69}  # inches


def printed_pages(browser):
    pdf = base64.b64decode(browser.execute_cdp_cmd("Page.printToPDF", A4)["data"])
    return len(re.findall(rb"/Type\s*/Page\b", pdf))


def lay_out_for_paper(browser):
    """As on A4 between margins of a centimetre."""
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 718, "height": 1000, "deviceScaleFactor": 1, "mobile": False})


def reaches_beyond(browser, selector):
    """How many of these elements begin or end outside the sheet."""
    return browser.execute_script("return [...document.querySelectorAll(arguments[0])].filter(e => e.getClientRects().length"
                                  " && (e.getBoundingClientRect().right > innerWidth + 1 || e.getBoundingClientRect().left < 0)).length", selector)


def test_paper_has_tables_that_fit_without_gaps_and_no_white_words(fake, browser):
    study = submit(fake, name="on paper", repeats=2, vary={"/inputs/contact/friction": [0.1, 0.3, 0.5],
                                                           "/inputs/wall/friction": [0.3, 0.5]})
    last = fake.submit(project="opened")
    fake.ended(last)
    while fake.get(f"/studies/{study}?wait=10").json()["status"] != "successful":
        pass
    browser.get(fake.url)
    until(browser, lambda b: len(find_all(b, "tr.job .value")) == 13)
    assert printed_pages(browser) <= 2  # a row is 2 cm high
    find(browser, f"#job-{last} .opener").click()
    until(browser, lambda b: find(b, f"#detail-{last} .facts"))
    assert printed_pages(browser) <= 3
    lay_out_for_paper(browser)
    assert find(browser, "#jobs thead").is_displayed() and reaches_beyond(browser, "th, td, dd, svg") == 0
    assert [link.text.split()[0] for link in find_all(browser, ".filter") if link.is_displayed()] == ["all"]
    assert find(browser, ".filter.all").value_of_css_property("color") == "rgba(0, 0, 0, 1)"
    browser.get(f"{fake.url}/web/studies.html#{study}")
    until(browser, lambda b: len(find_all(b, "#cases tbody tr")) == 6)
    assert reaches_beyond(browser, "th, td") == 0


class SlowLine(socketserver.ThreadingTCPServer):
    """Passes requests on to a daemon, and of the answer to GET /jobs a tenth at a time, one each pause (s); where it stops, half."""

    daemon_threads = allow_reuse_address = True

    def __init__(self, port, pause):
        super().__init__(("127.0.0.1", 0), SlowLine.Request)
        self.port, self.pause, self.stops = port, pause, False
        threading.Thread(target=self.serve_forever, daemon=True).start()

    class Request(socketserver.BaseRequestHandler):
        def handle(self):
            head = b""
            while b"\r\n\r\n" not in head:
                head += self.request.recv(4096) or b"\r\n\r\n"
            head = re.sub(rb"(?im)^(accept-encoding|connection):.*\r\n", b"", head).replace(b"\r\n", b"\r\nConnection: close\r\n", 1)
            with socket.create_connection(("127.0.0.1", self.server.port), timeout=60) as daemon:
                daemon.sendall(head)
                answer = b"".join(iter(lambda: daemon.recv(65536), b""))
            pieces = 10 if head.startswith(b"GET /jobs") else 1
            size = len(answer) // pieces + 1
            for k in range(5 if self.server.stops and pieces > 1 else pieces):
                time.sleep(self.server.pause if pieces > 1 else 0)
                self.request.sendall(answer[k * size:(k + 1) * size])
            while self.server.stops and pieces > 1 and self.request.recv(4096):
                pass


def test_a_list_may_take_long_as_long_as_it_comes(fake, browser):
    """Uncompressed. The page's clock goes twelve times as fast, so that it waits for 1.7 s, not for 20; the list takes 3 s."""
    for k in range(5):
        fake.submit(project=f"slow {k}")
    line = SlowLine(fake.port, 0.3)
    browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {
        "source": "const late = window.setTimeout; window.setTimeout = (what, ms, ...more) => late(what, ms / 12, ...more)"})
    browser.get(f"http://127.0.0.1:{line.server_address[1]}/")
    until(browser, lambda b: len(find_all(b, "tr.job")) == 5)
    assert not find(browser, "#trouble").is_displayed()
    line.stops = True
    until(browser, lambda b: "no answer for 20 s" in find(b, "#trouble").text)
    line.shutdown()
    line.server_close()
