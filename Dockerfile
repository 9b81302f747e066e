# Any image of Debian or Ubuntu with Python 3.13 and pip will do.
ARG BASE=python:3.13-slim

FROM ${BASE} AS build
RUN pip install --no-cache-dir uv
ENV UV_PROJECT_ENVIRONMENT=/opt/venv UV_LINK_MODE=copy UV_NO_CACHE=1 UV_PYTHON_DOWNLOADS=never UV_COMPILE_BYTECODE=1
WORKDIR /srv/escape-explorer
# Without the sources first: a change in them alone does not fetch every package anew.
COPY pyproject.toml README.md LICENSE ./
RUN uv sync --no-dev --no-install-project
COPY engine engine
COPY app app
COPY reproduction reproduction
COPY cli cli
RUN uv sync --no-dev && /opt/venv/bin/python -m compileall -q app cli engine reproduction

FROM ${BASE}
COPY --from=build /opt/venv /opt/venv
COPY --from=build /srv/escape-explorer /srv/escape-explorer
# The sources are not the user's to write: whatever is written goes to the volume, and lasts as long as that. By number, so that an
# orchestrator can see that it is not root.
RUN useradd --system --uid 10001 --create-home explorer && install --directory --owner=explorer /var/cache/escape-explorer
ENV PATH=/opt/venv/bin:$PATH \
    PYTHONUNBUFFERED=1 \
    PYTHONDONTWRITEBYTECODE=1 \
    ESCAPE_EXPLORER_ONLY_IDLE=yes \
    MALLOC_ARENA_MAX=2 \
    ESCAPE_EXPLORER_CACHE=/var/cache/escape-explorer \
    MPLCONFIGDIR=/var/cache/escape-explorer/matplotlib
# Whose pages may talk to this server besides its own, as behind a proxy that renames it: host:port, with commas between.
ENV BOKEH_ALLOW_WS_ORIGIN=localhost:5006,127.0.0.1:5006
WORKDIR /srv/escape-explorer
USER 10001
# As the server does at its start. Kernels fit the processor that compiled them; on another kind they are compiled anew into the
# volume, which begins as a copy of what is here.
RUN python -c "from app.server.warmup import prepare_now; prepare_now()"
VOLUME /var/cache/escape-explorer
EXPOSE 5006
HEALTHCHECK --start-period=3m \
    CMD ["python", "-c", "from urllib.request import urlopen; urlopen('http://127.0.0.1:5006/readiness', timeout=10)"]
CMD ["panel", "serve", "app", "--address", "0.0.0.0", "--port", "5006"]
