# Any Debian or Ubuntu image with Python 3.13 and pip. A tag can be moved, a digest (python@sha256:…) cannot.
ARG BASE=python:3.13.7-slim-bookworm

FROM ${BASE} AS build
RUN pip install --no-cache-dir uv
ENV VIRTUAL_ENV=/opt/venv UV_LINK_MODE=copy UV_NO_CACHE=1 UV_PYTHON_DOWNLOADS=never UV_COMPILE_BYTECODE=1
WORKDIR /srv/escape-explorer
# Install the dependencies before copying the sources, so that this layer is cached when only the sources change.
COPY deploy/requirements.txt ./
RUN uv venv /opt/venv && uv pip install --require-hashes --requirements requirements.txt
COPY pyproject.toml README.md LICENSE hatch_build.py ./
COPY engine engine
COPY plots plots
COPY app app
COPY reproduction reproduction
COPY cli cli
COPY escape_explorer escape_explorer
RUN uv pip install --no-deps --editable . && /opt/venv/bin/python -m compileall -q app cli engine escape_explorer plots reproduction

FROM ${BASE}
COPY --from=build /opt/venv /opt/venv
COPY --from=build /srv/escape-explorer /srv/escape-explorer
# The sources are read-only for this user; all files are written to the volume. The numeric user id lets an orchestrator verify
# that it is not root.
RUN useradd --system --uid 10001 --create-home explorer && install --directory --owner=explorer /var/cache/escape-explorer
ENV PATH=/opt/venv/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    PYTHONDONTWRITEBYTECODE=1 \
    ESCAPE_EXPLORER_CACHE=/var/cache/escape-explorer \
    MPLCONFIGDIR=/var/cache/escape-explorer/matplotlib
# Origins that may open a WebSocket, such as the public name of a proxy: host:port, separated by commas.
ENV BOKEH_ALLOW_WS_ORIGIN=localhost:5006,127.0.0.1:5006
WORKDIR /srv/escape-explorer
USER 10001
# Compile the kernels, as the server does when it starts. Machine code is specific to a processor type; on another one the
# kernels are compiled again into the volume, which is initialized with a copy of this folder.
RUN python -c "from app.server.lifecycle.warmup import warm_up; warm_up()"
VOLUME /var/cache/escape-explorer
EXPOSE 5006
HEALTHCHECK --start-period=3m \
    CMD ["python", "-c", "from urllib.request import urlopen; urlopen('http://127.0.0.1:5006/readiness', timeout=10)"]
CMD ["panel", "serve", "app", "--address", "0.0.0.0", "--port", "5006"]
