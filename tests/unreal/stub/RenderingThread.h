#pragma once
void FlushRenderingCommands();
