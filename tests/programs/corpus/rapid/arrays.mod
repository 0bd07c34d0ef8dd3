MODULE Arrays
  CONST jointtarget jPath{3}:=[[[10,-20,30,0,45,5],[9E9,9E9,9E9,9E9,9E9,9E9]],
    [[10,-20,30,0,45,5],[9E9,9E9,9E9,9E9,9E9,9E9]],
    [[nTurn,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];
  CONST robtarget pGrid{2}:=[[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];
  PROC main()
    VAR num i;
    FOR i FROM 1 TO Dim(jPath,1) DO
      MoveAbsJ jPath{i},v100,z10,tool0;
    ENDFOR
    MoveJ pGrid{2},v100,fine,tool0;
  ENDPROC
ENDMODULE
