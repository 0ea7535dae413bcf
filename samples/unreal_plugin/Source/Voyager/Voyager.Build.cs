using System.IO;
using UnrealBuildTool;

// `cmake --install build/library --prefix Source/ThirdParty/Voyager` puts Voyager where this file
// looks for it.
public class Voyager : ModuleRules
{
    public Voyager(ReadOnlyTargetRules Target) : base(Target)
    {
        PCHUsage = PCHUsageMode.UseExplicitOrSharedPCHs;
        PublicDependencyModuleNames.AddRange(new string[] { "Core" });
        PrivateDependencyModuleNames.AddRange(
            new string[] { "CoreUObject", "Engine", "RHI", "RenderCore", "Renderer", "VulkanRHI" });
        AddEngineThirdPartyPrivateStaticDependencies(Target, "Vulkan");

        string Installed = Path.Combine(PluginDirectory, "Source", "ThirdParty", "Voyager");
        PrivateIncludePaths.Add(Path.Combine(Installed, "include"));
        PublicAdditionalLibraries.Add(Path.Combine(Installed, "lib", "libvoyager.so"));
        PublicRuntimeLibraryPaths.Add(Path.Combine(Installed, "lib"));
        RuntimeDependencies.Add(Path.Combine(Installed, "lib", "libvoyager*.so*"));
    }
}
